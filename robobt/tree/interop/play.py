"""A tree file as a function: what plays are."""

from __future__ import annotations

import inspect
from functools import partial
from pathlib import Path

from py_trees.behaviour import Behaviour

from robobt.config.yaml import read_limited
from robobt.tree.interop.build import build_tree
from robobt.tree.interop.model import Name, Text, TreeFile, TreeFileError, specs_of
from robobt.tree.interop.vocabulary import Vocabulary
from robobt.tree.interop.xml_elements import MAX_XML_BYTES, read_element
from robobt.tree.interop.xml_reader import parse_xml
from robobt.tree.interop.yaml import parse_yaml

_PROJECT = ".btproj"
FILE_ENDINGS = (".yaml", ".yml", ".xml", _PROJECT)
"""How the names of tree files end; the last is that of Groot2's projects, which include others."""

_MOST_FILES = 100
"""How many files a project may include."""


class FilePlay:
    """Builds a new tree of a file at every call.

    Its signature is that of the main tree's parameters, so that it can be listed,
    checked and called as a play that is written in Python.
    """

    def __init__(self, file: TreeFile, vocabulary: Vocabulary) -> None:
        self.file = file
        self._vocabulary = vocabulary
        main = file.trees[file.main]
        self.__name__ = self.__qualname__ = main.name
        self.__doc__ = main.description
        entries = [
            inspect.Parameter(
                entry.name,
                inspect.Parameter.KEYWORD_ONLY,
                default=inspect.Parameter.empty if entry.required else entry.default,
                annotation=entry.hint,
            )
            for entry in main.parameters.values()
            # Defaults that name entries, or whose type is unknown, exist only in XML.
            if not isinstance(entry.default, Name | Text)
        ]
        self.__annotations__ = {entry.name: entry.annotation for entry in entries}
        self.__signature__ = inspect.Signature(entries)

    def __call__(self, **given: object) -> Behaviour:
        """Build a new tree.

        Raises:
            TypeError: a parameter is unknown or missing.
            TreeFileError: a value does not fit.
        """
        self.__signature__.bind(**given)
        return build_tree(self.file, self._vocabulary, given)


def load_tree_file(path: str | Path, vocabulary: Vocabulary) -> TreeFile:
    """Load the trees of a file, YAML or XML by its ending, and build the main tree once as a check.

    Raises:
        TreeFileError: one line that names the file, the line and what is wrong.
    """
    path = Path(path)
    if path.suffix not in FILE_ENDINGS:
        raise TreeFileError(str(path), f"its ending is none of {', '.join(FILE_ENDINGS)}")
    text = read_limited(path, MAX_XML_BYTES, TreeFileError)
    if path.suffix in (".yaml", ".yml"):
        file = parse_yaml(text, vocabulary, str(path))
    else:
        include = partial(_included, path) if path.suffix == _PROJECT else None
        file = parse_xml(text, vocabulary, str(path), include)
    for name, definition in file.trees.items():
        folder = Path(file.source_of(name)).parent
        for spec in specs_of(definition.root):
            placed = {name: vocabulary.place(value, folder) for name, value in spec.parameters.items()}
            spec.parameters.update(placed)
    try_build(file, vocabulary)
    return file


def tree_files(path: str | Path) -> list[Path]:
    """Return the files that a tree file consists of: itself, and those that a project includes.

    Raises:
        TreeFileError: it cannot be read.
    """
    path = Path(path)
    if path.suffix != _PROJECT:
        return [path]
    parts = read_element(read_limited(path, MAX_XML_BYTES, TreeFileError), str(path)).children
    return [path, *[path.parent / part.attributes.get("path", "") for part in parts if part.tag == "include"]]


def _included(project: Path, file: str) -> tuple[str, bytes]:
    if not file.endswith(".xml"):
        raise TreeFileError(file, "a project includes files whose ending is .xml")
    if len(tree_files(project)) > 1 + _MOST_FILES:
        raise TreeFileError(file, f"a project includes at most {_MOST_FILES} files")
    path = project.parent / file
    return str(path), read_limited(path, MAX_XML_BYTES, TreeFileError)


def try_build(file: TreeFile, vocabulary: Vocabulary) -> None:
    """Build a file's main tree with its parameters' defaults, if they all have one."""
    main = file.trees[file.main]
    if file.language == "xml" or not any(entry.required for entry in main.parameters.values()):
        build_tree(file, vocabulary)
