"""What is wrong with a message of a page, in words for whoever wrote the page."""

from __future__ import annotations

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from robobt.config.errors import one_line, short_repr
from robobt.live.messages import FORMS, MOST_MESSAGE_BYTES, READER


def problem_with(data: str | bytes) -> str:
    """Return what is wrong with a message that is refused, for whoever sent it.

    Args:
        data: the message, of which :func:`robobt.live.messages.read` returns none.
    """
    if len(data) > MOST_MESSAGE_BYTES:
        return f"A message has at most {MOST_MESSAGE_BYTES} bytes."
    try:
        READER.validate_json(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        asked = next(iter(first["loc"]), "")
        if asked in FORMS:
            fields = [name for name in FORMS[str(asked)].model_fields if name != "do"]
            takes = ", ".join(fields) or "nothing"
            return f"{asked}: {_said_of(first)}. The message takes: {takes}."
    return f'A message is a JSON object whose "do" is one of: {", ".join(FORMS)}.'


def _said_of(problem: ErrorDetails) -> str:
    """Return in words which field of a message is wrong, what it may be, and what it is."""
    place = one_line(".".join(map(str, problem["loc"][1:])), 40)
    kind = problem["type"]
    if kind == "missing":
        return f"{place} is missing"
    if kind == "extra_forbidden":
        return f"it has no {place}"
    allowed = _MUST_BE.get(kind, "something else").format(**problem.get("ctx", {}))
    return f"{place} must be {one_line(allowed, 200)}, not {short_repr(problem['input'])}"


_MUST_BE = {
    **dict.fromkeys(("bool_type", "bool_parsing"), "true or false"),
    **dict.fromkeys(("int_type", "int_parsing", "int_parsing_size", "int_from_float"), "a whole number"),
    **dict.fromkeys(("float_type", "float_parsing", "finite_number"), "a number"),
    "greater_than_equal": "at least {ge:g}",
    "less_than_equal": "at most {le:g}",
    "string_type": "a text",
    "string_too_long": "at most {max_length} characters long",
    "string_pattern_mismatch": 'a robot, such as "blue 1"',
    "enum": "{expected}",
    "literal_error": "{expected}",
    "dict_type": "an object",
    "list_type": "a list",
    "too_long": "at most {max_length} entries long",
}
"""What a field may be, by pydantic's types of errors."""
