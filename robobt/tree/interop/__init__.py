"""Trees in files: YAML, and the XML of BehaviorTree.CPP 4 that Groot2 opens; see docs/tree_files.md."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily
from robobt.tree.interop.build import build_tree as build_tree
from robobt.tree.interop.describe import describe_tree as describe_tree
from robobt.tree.interop.model import Entry as Entry
from robobt.tree.interop.model import TreeFile as TreeFile
from robobt.tree.interop.model import TreeFileError as TreeFileError
from robobt.tree.interop.play import FILE_ENDINGS as FILE_ENDINGS
from robobt.tree.interop.play import FilePlay as FilePlay
from robobt.tree.interop.play import load_tree_file as load_tree_file
from robobt.tree.interop.play import tree_files as tree_files
from robobt.tree.interop.play import try_build as try_build
from robobt.tree.interop.vocabulary import Vocabulary as Vocabulary
from robobt.tree.interop.xml_reader import parse_xml as parse_xml
from robobt.tree.interop.yaml import parse_yaml as parse_yaml
from robobt.tree.interop.yaml import write_yaml as write_yaml

if TYPE_CHECKING:
    from robobt.tree.interop.xml_writer import write_xml as write_xml
else:
    # Python's library for XML imports what it takes to open web pages.
    __getattr__, __dir__ = lazily(__name__, {"write_xml": "xml_writer"})
