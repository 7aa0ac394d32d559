"""The shots for an experiment."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
from sklearn.model_selection import train_test_split

from robobt.config.resources import models_folder
from robobt.shots.data.files import read_shots
from robobt.shots.data.inputs import goals
from robobt.shots.data.schema import ShotDataError
from robobt.shots.predict.networks import ShotNetwork, author_network

AUTHOR_WEIGHTS = "author_predictor.json"
TEST_SHARE = 201 / 743
"""The paper's share of shots to test on, for data that does not say."""

_NAMES = ("paper_shots.parquet", "paper_shots.csv", "shots.parquet", "shots.csv")


@dataclass(frozen=True)
class ShotSets:
    """Shots to learn from, ``train``, and shots to ``test`` on.

    In the table of :mod:`robobt.shots.data.schema`; ``author`` is the published predictor where it lies
    beside the shots, ``source`` where they come from, for whoever reads the result.
    """

    train: pa.Table
    test: pa.Table
    author: ShotNetwork | None
    source: str


def load_shot_sets(data: str | Path | None = None, seed: int = 0) -> ShotSets:
    """Load the shots of a folder or a file.

    Args:
        data: a folder with ``train.csv`` and ``test.csv`` (or ``.parquet``), and the
            author's weights if they are there; or a single file, whose column
            ``early_stop_split`` says which shots are to test on, and else 201 of
            743 are drawn. None for shots collected here: ``out/paper_shots.parquet``,
            then those in a clone of the repository.
        seed: of that draw.

    Raises:
        ShotDataError: there are none, or a file is wrong.
    """
    place = Path(data) if data is not None else _own_shots()
    if not place.is_dir():
        return _split(read_shots(place), place, seed)
    weights = place / AUTHOR_WEIGHTS
    return ShotSets(
        read_shots(split_file(place, "train")),
        read_shots(split_file(place, "test")),
        author_network(weights) if weights.is_file() else None,
        str(place),
    )


def split_file(folder: Path, name: str) -> Path:
    """Return the file of a folder that holds the shots to train on ("train") or to test on ("test").

    Raises:
        ShotDataError: there is none.
    """
    for ending in (".csv", ".parquet"):
        if (folder / f"{name}{ending}").is_file():
            return folder / f"{name}{ending}"
    raise ShotDataError(f"{folder}: has neither {name}.csv nor {name}.parquet")


def _own_shots() -> Path:
    for folder in (Path("out"), models_folder()):
        for name in _NAMES:
            if (folder / name).is_file():
                return folder / name
    raise ShotDataError(
        "there are no shots: collect some with 'robobt shots collect --protocol paper "
        "--out out/paper_shots.parquet', or name them with --data; a clone of the repository has "
        "models/paper_shots.parquet"
    )


def _split(table: pa.Table, place: Path, seed: int) -> ShotSets:
    named = np.array(table.column("early_stop_split").to_pylist()) == "test"
    if not named.any():
        try:
            everyone, labels = np.arange(len(named)), goals(table)
            named[train_test_split(everyone, test_size=TEST_SHARE, random_state=seed, stratify=labels)[1]] = (
                True
            )
        except ValueError as error:
            raise ShotDataError(f"{place}: {error}") from error
    if named.all():
        raise ShotDataError(f"{place}: has shots to test on only")
    rows = np.arange(len(named))
    return ShotSets(table.take(pa.array(rows[~named])), table.take(pa.array(rows[named])), None, str(place))
