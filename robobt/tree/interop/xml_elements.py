"""XML elements, with lines, from text of unknown origin.

No document type, no entities, no processing instructions: there is no file
beside this one and nothing grows as it is read.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NoReturn
from xml.parsers import expat

from robobt.tree.interop.model import TreeFileError

MAX_XML_BYTES = 1024 * 1024
"""Largest text that is read."""

MAX_XML_DEPTH = 100
"""Deepest nesting that is followed."""


@dataclass(slots=True)
class Element:
    """One element."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)
    text: str = ""


def read_element(content: bytes | str, source: str) -> Element:
    """Return the outermost element of a document."""
    if len(content) > MAX_XML_BYTES:
        raise TreeFileError(source, f"is larger than {MAX_XML_BYTES // 1024} KiB")
    reader = _ElementReader(source)
    try:
        reader.parser.Parse(content, True)
    except expat.ExpatError as error:
        problem = f"is not XML: {expat.ErrorString(error.code)}"
        raise TreeFileError(source, problem, line=error.lineno) from error
    except (LookupError, UnicodeError, ValueError) as error:
        # An encoding that does not exist, or that the text does not keep to.
        if isinstance(error, TreeFileError):
            raise
        raise TreeFileError(source, f"is not text: {error}", line=reader.line) from error
    assert reader.root is not None
    return reader.root


class _ElementReader:
    def __init__(self, source: str) -> None:
        self.source = source
        self.root: Element | None = None
        self.open: list[Element] = []
        self.parser = parser = expat.ParserCreate()
        parser.ordered_attributes = True
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._text
        parser.StartDoctypeDeclHandler = self._no_doctype
        parser.EntityDeclHandler = self._no_doctype
        parser.ProcessingInstructionHandler = self._no_instruction

    @property
    def line(self) -> int:
        return self.parser.CurrentLineNumber

    def _start(self, tag: str, attributes: list[str]) -> None:
        element = Element(tag, dict(zip(attributes[::2], attributes[1::2], strict=True)), self.line)
        if len(self.open) >= MAX_XML_DEPTH:
            raise TreeFileError(self.source, f"nested deeper than {MAX_XML_DEPTH} levels", line=self.line)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, _tag: str) -> None:
        self.open.pop()

    def _text(self, text: str) -> None:
        self.open[-1].text += text

    def _no_doctype(self, *_: object) -> NoReturn:
        raise TreeFileError(
            self.source, "a document type and entities of one's own are not allowed", line=self.line
        )

    def _no_instruction(self, target: str, _data: str) -> NoReturn:
        raise TreeFileError(self.source, f"the instruction <?{target}?> is not allowed", line=self.line)


class ElementChecker:
    """Checks elements of one document."""

    def __init__(self, source: str) -> None:
        self.source = source

    def attributes(self, element: Element, known: Iterable[str], needed: Iterable[str]) -> None:
        """Check the names of an element's attributes."""
        known = tuple(known)
        for name in element.attributes:
            if name not in known:
                has = f"it has {', '.join(known)}" if known else "it has none"
                raise self.error(element, f"<{element.tag}> has no attribute {name}; {has}")
        for name in needed:
            if name not in element.attributes:
                raise self.error(element, f"<{element.tag}> needs the attribute {name}")

    def no_text(self, element: Element) -> None:
        """Check that there is no text in an element."""
        if element.text.strip():
            raise self.error(element, f"there is text in <{element.tag}>: {element.text.strip()[:40]!r}")

    def word(self, element: Element, attribute: str) -> str:
        """Return an attribute that is a text on one line."""
        text = element.attributes[attribute]
        if not text.strip() or not text.isprintable():
            raise self.error(element, f"{attribute} of <{element.tag}> is a text on one line")
        return text

    def error(self, element: Element, problem: str) -> TreeFileError:
        """Return an error at an element."""
        return TreeFileError(self.source, problem, line=element.line)
