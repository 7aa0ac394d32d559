"""What would have happened: moments of logged matches, played on in the simulator with other decisions.

docs/what_if.md describes it.
"""

from robobt.what_if.branches import Branch as Branch
from robobt.what_if.branches import Branches as Branches
from robobt.what_if.compare import DecisionFigures as DecisionFigures
from robobt.what_if.compare import compare_decisions as compare_decisions
from robobt.what_if.decisions import BallDecision as BallDecision
from robobt.what_if.decisions import decisions_of as decisions_of
from robobt.what_if.logged import LoggedMatch as LoggedMatch
from robobt.what_if.logged import WhatIfError as WhatIfError
from robobt.what_if.logged import load_logged as load_logged
from robobt.what_if.moments import Moment as Moment
from robobt.what_if.moments import promising_moments as promising_moments
from robobt.what_if.scan import Found as Found
from robobt.what_if.scan import scan as scan
