"""What a field and its robots are like, identified from what cameras saw and what robots were sent."""

from robobt.identify.estimate import Estimate as Estimate
from robobt.identify.observations import Observations as Observations
from robobt.identify.preset_file import write_preset as write_preset
from robobt.identify.report import Identification as Identification
from robobt.identify.report import identify as identify
