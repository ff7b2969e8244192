"""servoid: a DC servo motor's model from its voltage and encoder counts, and which physics it lacks.

A recording comes from arrays (`Recording`) or from a file (`read`); `fit` fits a model to one or several of them, and
`diagnose` names the physical effects that they show and the linear motor lacks. Results hold the JSON of the command line
(`.json`), number for number.
"""

from ._servoid import EFFECTS, Error, UsageError, __version__
from ._batch import Done, batch
from ._diagnosis import Diagnosis, Step, diagnose
from ._fit import Fit, Parameter, fit
from ._model import Model
from ._population import Population, population
from ._recording import Recording, read

__all__ = [
    "EFFECTS",
    "Diagnosis",
    "Done",
    "Error",
    "Fit",
    "Model",
    "Parameter",
    "Population",
    "Recording",
    "Step",
    "UsageError",
    "__version__",
    "batch",
    "diagnose",
    "fit",
    "population",
    "read",
]
