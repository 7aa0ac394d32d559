"""The rules that an automatic referee watches, one class each.

Thresholds are the rules' own (RoboCup SSL rules of 2026) with the tolerances of the league's
AutoReferee (TIGERs Mannheim), so that both see the same things.
"""
