"""Qualitative spatial relations: a language, its reasoning, and object search by it.

Names are imported when they are first used; what there is, and from where, stands in `__init__.pyi`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
