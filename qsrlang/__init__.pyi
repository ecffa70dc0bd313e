from .cli.notebook import load_ipython_extension, unload_ipython_extension
from .errors import (
    BlockedPoseError,
    FileError,
    ImpossibleConditionError,
    MissingFacingError,
    NoNavigablePoseError,
    NoRoomError,
    OutsideMapError,
    QSRError,
    UnansweredQueryError,
    UnknownNameError,
    UnplaceableError,
    UnreachedTargetError,
    ValueRangeError,
)
from .experiments.comparing import compare
from .experiments.days import Day, search_and_learn
from .experiments.pictures import draw_story
from .experiments.recording import Experiment
from .experiments.scenarios import Scenario, load_scenario
from .experiments.statistics import Interval
from .experiments.stories import Opening, SearchStory, open_search, search
from .experiments.summaries import ArmSummary, Comparison
from .experiments.trials import Trial
from .experiments.viewing import ask_views
from .geometry.angles import relative_angle
from .geometry.pose import Pose2
from .geometry.viewcone import Sector, Triangle, ViewCone
from .language.diagnostics import Diagnostic, Diagnostics, Edit, LanguageError
from .language.parser import parse, parse_formula, parse_landmark, parse_place, parse_query
from .language.printing.formatter import format_source
from .language.printing.printer import print_document, print_query
from .learning.differences import Change, differences
from .learning.experience import Experience, experience_of
from .learning.formats.tables import write_observations
from .learning.fusion import Fusion, learn_fusion
from .learning.learner import Learned, learn
from .learning.merging import Lesson, learn_into
from .learning.observations import Observations
from .learning.reading import read_observations
from .learning.rhythm import Rhythm, rhythm_of
from .learning.screening import Reading
from .learning.searches import sightings_of
from .learning.specific import PlaceLearner
from .learning.store import ObservationStore
from .learning.sums import PlacementSums, sums_of
from .learning.writing import Contexts
from .maps.mapping import VoxelMapper
from .maps.navigation import NavigationGrid, occupancy_from_voxels
from .maps.occupancy import Cell, OccupancyGrid
from .maps.octomap import OctoMap, read_octomap
from .maps.paths import DistanceField, shortest_path
from .maps.rosmap import read_ros_map
from .maps.supports import Supports, find_supports
from .maps.voxels import VoxelGrid
from .mixtures.answers import Component, Where
from .mixtures.explanation import Explanation, Proof, Reason, Spot
from .mixtures.gaussian import GaussianMixture
from .mixtures.information import LandmarkRanking, LandmarkValue
from .mixtures.loading import load, parse_knowledge
from .mixtures.probability import Probability
from .mixtures.queries import Answer, KnowledgeBase
from .mixtures.scenes import SceneSamples
from .planning.atlas import Atlas, Lattice
from .planning.belief import Belief, voxel_weights
from .planning.detecting import Detector
from .planning.doubt import Doubt
from .planning.frusta import Extent
from .planning.goals import Goal
from .planning.instances import Instances
from .planning.loop import search_world
from .planning.noise import Noise, NoisyWorld
from .planning.outcome import Limits, SearchResult, SearchStep
from .planning.planners.believing import BeliefPlanner
from .planning.planners.paper import QSRPlanner, RandomPlanner
from .planning.planners.planner import Planner
from .planning.problem import ViewProblem
from .planning.ranking import RankedView, RankedViews, rank_views
from .planning.repeats import Repeats
from .planning.seeding import TrialSeeds
from .planning.sensing import Camera, Robot
from .planning.sight import Sight
from .planning.strategies.exact import Exact
from .planning.strategies.gain import Gain
from .planning.strategies.index import Index
from .planning.strategies.nearest import Nearest
from .planning.strategies.rollout import Rollout
from .planning.strategies.tour import Tour
from .planning.views import Views
from .planning.visibility import in_view, view_values
from .planning.world import Detection, Drive, Look, World
from .plotting.answers import draw_answer
from .plotting.canvas import save_figure
from .plotting.curves import draw_curves
from .plotting.maps import draw_map
from .plotting.mixtures import draw_mixture
from .plotting.statistics import draw_found_by_time
from .plotting.steps import draw_search_step
from .plotting.voxels import draw_voxels
from .relations.algebra import compose, converse, entailed, neighbours
from .relations.checking import check, check_text
from .relations.consistency.conflicts import Conflict, Consistency, Impossible, Relaxation
from .relations.consistency.deciding import find_conflicts
from .relations.contexts import Circumstances
from .relations.describing import relations_between
from .relations.graph import Landmark, RelationGraph
from .relations.qualify import TPCC, direction_of, qualify
from .resources import data_root
from .simulation.objects import Placement
from .simulation.picture import scene_picture
from .simulation.roomfiles import load_room
from .simulation.rooms import Room
from .simulation.survey import survey_room
from .simulation.world import PybulletWorld

__all__ = [
    "TPCC",
    "Answer",
    "ArmSummary",
    "Atlas",
    "Belief",
    "BeliefPlanner",
    "BlockedPoseError",
    "Camera",
    "Cell",
    "Change",
    "Circumstances",
    "Comparison",
    "Component",
    "Conflict",
    "Consistency",
    "Contexts",
    "Day",
    "Detection",
    "Detector",
    "Diagnostic",
    "Diagnostics",
    "DistanceField",
    "Doubt",
    "Drive",
    "Edit",
    "Exact",
    "Experience",
    "Experiment",
    "Explanation",
    "Extent",
    "FileError",
    "Fusion",
    "Gain",
    "GaussianMixture",
    "Goal",
    "Impossible",
    "ImpossibleConditionError",
    "Index",
    "Instances",
    "Interval",
    "KnowledgeBase",
    "Landmark",
    "LandmarkRanking",
    "LandmarkValue",
    "LanguageError",
    "Lattice",
    "Learned",
    "Lesson",
    "Limits",
    "Look",
    "MissingFacingError",
    "NavigationGrid",
    "Nearest",
    "NoNavigablePoseError",
    "NoRoomError",
    "Noise",
    "NoisyWorld",
    "ObservationStore",
    "Observations",
    "OccupancyGrid",
    "OctoMap",
    "Opening",
    "OutsideMapError",
    "PlaceLearner",
    "Placement",
    "PlacementSums",
    "Planner",
    "Pose2",
    "Probability",
    "Proof",
    "PybulletWorld",
    "QSRError",
    "QSRPlanner",
    "RandomPlanner",
    "RankedView",
    "RankedViews",
    "Reading",
    "Reason",
    "RelationGraph",
    "Relaxation",
    "Repeats",
    "Rhythm",
    "Robot",
    "Rollout",
    "Room",
    "Scenario",
    "SceneSamples",
    "SearchResult",
    "SearchStep",
    "SearchStory",
    "Sector",
    "Sight",
    "Spot",
    "Supports",
    "Tour",
    "Trial",
    "TrialSeeds",
    "Triangle",
    "UnansweredQueryError",
    "UnknownNameError",
    "UnplaceableError",
    "UnreachedTargetError",
    "ValueRangeError",
    "ViewCone",
    "ViewProblem",
    "Views",
    "VoxelGrid",
    "VoxelMapper",
    "Where",
    "World",
    "ask_views",
    "check",
    "check_text",
    "compare",
    "compose",
    "converse",
    "data_root",
    "differences",
    "direction_of",
    "draw_answer",
    "draw_curves",
    "draw_found_by_time",
    "draw_map",
    "draw_mixture",
    "draw_search_step",
    "draw_story",
    "draw_voxels",
    "entailed",
    "experience_of",
    "find_conflicts",
    "find_supports",
    "format_source",
    "in_view",
    "learn",
    "learn_fusion",
    "learn_into",
    "load",
    "load_ipython_extension",
    "load_room",
    "load_scenario",
    "neighbours",
    "occupancy_from_voxels",
    "open_search",
    "parse",
    "parse_formula",
    "parse_knowledge",
    "parse_landmark",
    "parse_place",
    "parse_query",
    "print_document",
    "print_query",
    "qualify",
    "rank_views",
    "read_observations",
    "read_octomap",
    "read_ros_map",
    "relations_between",
    "relative_angle",
    "rhythm_of",
    "save_figure",
    "scene_picture",
    "search",
    "search_and_learn",
    "search_world",
    "shortest_path",
    "sightings_of",
    "sums_of",
    "survey_room",
    "unload_ipython_extension",
    "view_values",
    "voxel_weights",
    "write_observations",
]
