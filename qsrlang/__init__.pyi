from .errors import FileError, MissingFacingError, NoRoomError, QSRError, UnknownNameError, UnreachedTargetError
from .geometry.pose import Pose2
from .language.diagnostics import Diagnostic, LanguageError
from .language.parser import parse, parse_landmark, parse_place, parse_query
from .mixtures.answers import Component, Where
from .mixtures.gaussian import GaussianMixture
from .mixtures.queries import KnowledgeBase, load, parse_knowledge
from .plotting.answers import draw_answer
from .plotting.canvas import save_figure

__all__ = [
    "Component",
    "Diagnostic",
    "FileError",
    "GaussianMixture",
    "KnowledgeBase",
    "LanguageError",
    "MissingFacingError",
    "NoRoomError",
    "Pose2",
    "QSRError",
    "UnknownNameError",
    "UnreachedTargetError",
    "Where",
    "draw_answer",
    "load",
    "parse",
    "parse_knowledge",
    "parse_landmark",
    "parse_place",
    "parse_query",
    "save_figure",
]
