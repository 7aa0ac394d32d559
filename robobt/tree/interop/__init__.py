"""Trees in files: YAML, and the XML of BehaviorTree.CPP 4 that Groot2 opens; see docs/tree_files.md."""

from robobt.tree.interop.build import build_tree
from robobt.tree.interop.describe import describe_tree
from robobt.tree.interop.model import Entry, TreeFile, TreeFileError
from robobt.tree.interop.play import FILE_ENDINGS, FilePlay, load_tree_file, try_build
from robobt.tree.interop.vocabulary import Vocabulary
from robobt.tree.interop.xml_reader import parse_xml
from robobt.tree.interop.xml_writer import write_xml
from robobt.tree.interop.yaml import parse_yaml, write_yaml

__all__ = [
    "FILE_ENDINGS",
    "Entry",
    "FilePlay",
    "TreeFile",
    "TreeFileError",
    "Vocabulary",
    "build_tree",
    "describe_tree",
    "load_tree_file",
    "parse_xml",
    "parse_yaml",
    "try_build",
    "write_xml",
    "write_yaml",
]
