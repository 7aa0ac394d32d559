"""The rules that the automatic referee checks, one class each.

Thresholds are the rules' own (RoboCup SSL rules of 2026) with the tolerances of the league's
AutoReferee (TIGERs Mannheim), so that both report the same events.
"""
