"""A model's card as the page that model hubs show: Markdown below metadata in YAML.

The metadata are those of https://huggingface.co/docs/hub/model-cards, which other hubs read as well.
"""

from __future__ import annotations

from typing import Any

from robobt.config.yaml import write_yaml
from robobt.models.card import Measured, ModelCard
from robobt.models.file import ModelFile

_HUB_TASKS = {"policy": "reinforcement-learning", "shot_predictor": "tabular-classification"}
_HELD_OUT = {"policy": "starts that training never saw", "shot_predictor": "shots that training never saw"}


def hub_page(file: ModelFile, licence: str = "") -> str:
    """Return the page of a model, to be stored as ``README.md`` beside its file on a hub.

    Args:
        file: the model.
        licence: identifier of its licence, as "mit"; left out where it is empty, for the card does not say.
    """
    card = file.card
    metadata = write_yaml(hub_metadata(card, licence))
    told = {title: text.replace("|", r"\|") for title, text in _facts(file).items() if text}
    rows = "\n".join([f"| {title} | {text} |" for title, text in told.items()])
    results = "\n".join([_result(name, one) for name, one in card.held_out.items()])
    use = f'import robobt\n\nmodel = robobt.load_policy("{file.path.name}")'
    parts = [f"---\n{metadata}---\n\n# {card.name}\n"]
    if card.description:
        parts.append(f"{card.description}\n")
    parts.append(f"| | |\n| --- | --- |\n{rows}\n")
    if results:
        parts.append(
            f"## Results on {_HELD_OUT[card.kind]}\n\n| | value | interval | n |\n| --- | --- | --- | --- |\n"
            f"{results}\n"
        )
    parts.append(f"## Use\n\n```python\n{use}\n```\n")
    return "\n".join(parts)


def hub_metadata(card: ModelCard, licence: str = "") -> dict[str, Any]:
    """Return what a hub reads of a model: library, tags, kind of task and results.

    Args:
        card: the model's card.
        licence: as in :func:`hub_page`.
    """
    task = _HUB_TASKS[card.kind]
    tags = [task, "robotics", "robocup", "small-size-league", card.skill, card.algorithm]
    metadata: dict[str, Any] = {
        "library_name": "robobt",
        "pipeline_tag": task,
        "tags": [tag for tag in dict.fromkeys(tags) if tag],
    }
    if licence:
        metadata["license"] = licence
    if card.held_out:
        metadata["metrics"] = list(card.held_out)
        metadata["model-index"] = [
            {
                "name": card.name,
                "results": [
                    {
                        "task": {"type": task, "name": card.skill},
                        "dataset": {"type": card.observation.name, "name": _HELD_OUT[card.kind]},
                        "metrics": [_metric(name, one) for name, one in card.held_out.items()],
                    }
                ],
            }
        ]
    return metadata


def _metric(name: str, one: Measured) -> dict[str, Any]:
    about = one.model_dump(exclude={"value"}, exclude_none=True, exclude_defaults=True)
    return {"type": name, "name": name.replace("_", " "), "value": one.value, "args": about}


def _facts(file: ModelFile) -> dict[str, str]:
    card = file.card
    outputs = [f"{one.name} ({one.scale:g} {one.unit})" for one in card.outputs]
    limits = {} if card.limits is None else card.limits.model_dump(exclude_none=True)
    return {
        "skill": card.skill,
        "algorithm": card.algorithm,
        "observation": f"{card.observation.name}, version {card.observation.version}",
        "inputs": ", ".join(card.observation.features),
        "outputs, an output of 1 standing for": ", ".join(outputs),
        "time between decisions": "" if card.period is None else f"{card.period:g} s",
        "limits of the robot": ", ".join([f"{name} {value}" for name, value in limits.items()]),
        "seed": "" if card.seed is None else str(card.seed),
        "trained by": f"robobt {card.code_version or 'unknown'}, commit {card.code_commit or 'unknown'}",
        "file": f"{file.path.name}, {file.format}, {file.size} bytes",
        "SHA-256": file.sha256,
    }


def _result(name: str, one: Measured) -> str:
    within = (
        "" if one.low is None or one.high is None else f"{one.low:.4g} to {one.high:.4g} ({one.interval})"
    )
    value = f"{one.value:.4g}" if one.unit == "1" else f"{one.value:.4g} {one.unit}"
    return f"| {name.replace('_', ' ')} | {value} | {within} | {one.n} |"
