"""Numbers in sentences agree with their nouns."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import robobt
from robobt.config.wording import counted

NOUNS = (
    "bodies|cells|entrants|entries|episodes|files|frames|games|goals|learners|matches|models|nodes|numbers|"
    "packets|pairs|pictures|processes|robots|rounds|seeds|shots|skills|states|steps|successes|"
    "tasks|ticks|times|transitions|trials|viewers"
)
COUNT = re.compile(rf" (?:[a-z]+ )?(?:{NOUNS})\b")


def test_one_is_singular_and_all_else_is_plural() -> None:
    assert [counted(n, "trial") for n in (0, 1, 2)] == ["0 trials", "1 trial", "2 trials"]
    assert [counted(n, "match", "matches") for n in (1, 21)] == ["1 match", "21 matches"]


def unchecked(source: str) -> Iterator[str]:
    """Numbers in a source's texts that stand in front of a plural, whatever the number: constants may."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.JoinedStr):
            continue
        for value, text in zip(node.values, node.values[1:], strict=False):
            if isinstance(value, ast.FormattedValue) and isinstance(text, ast.Constant):
                number, found = ast.unparse(value.value), COUNT.match(str(text.value))
                if found and value.format_spec is None and not re.fullmatch("[A-Z_0-9]+", number):
                    yield f"{{{number}}}{found.group()}"


def test_a_count_in_a_message_is_never_a_plural_of_one() -> None:
    assert [*unchecked("f'in {n} trials'")] == ["{n} trials"]
    assert not [*unchecked("f'{MOST} trials, {mean:.1f} goals'")]
    package = Path(robobt.__file__).parent
    found = {
        f"{path.relative_to(package)}: {text}"
        for room in ("cli", "engines", "identify", "league", "live", "match", "tournament")
        for path in (package / room).rglob("*.py")
        if "proto" not in path.parts
        for text in unchecked(path.read_text(encoding="utf-8"))
    }
    assert found == set()
