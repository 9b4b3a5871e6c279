"""Belt-drive dynamics with absolute nodal coordinate finite elements.

>>> import hihna
>>> drive = hihna.Drive.built_in().with_(run__end_time=0.02)
>>> results = drive.run()
>>> results["driver.speed"].shape == results.time.shape
True

Numbers are in SI units, as in the drive file; text may carry a unit, such as ``"10 mm"``.
"""

from . import ancf
from ._native import InputError, ReadError, RunError, StructureError, __version__
from .drive import Drive
from .functions import load, profile
from .results import Results

__all__ = [
    "Drive",
    "InputError",
    "ReadError",
    "Results",
    "RunError",
    "StructureError",
    "__version__",
    "ancf",
    "load",
    "profile",
]
