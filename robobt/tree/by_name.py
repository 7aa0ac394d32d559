"""Values that are chosen by name: something registered, alone or with settings."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, GetCoreSchemaHandler, ValidationError
from pydantic_core import CoreSchema, core_schema

from robobt.config.errors import FieldError, message_of, short_repr
from robobt.config.validation import first_problem
from robobt.tree.registry import Registry


@dataclass(frozen=True)
class ByName:
    """Annotates a parameter that takes something registered by its name, alone or with settings.

    With ``Annotated[str | Mapping[str, object] | ShotRater, ByName(RATERS, ShotRater)]`` a file may say
    ``expected_goal`` or ``{name: expected_goal, threshold: 0.8}``, and Python may give a rater as well.
    What has settings is registered as a pydantic model, whose fields they are. Validation makes a model
    of a mapping; a name stays a name, in a mapping too where what it names has no settings.

    Args:
        registry: what is known by name.
        made: the type of what is registered, once it is made.
        others: whether a name that is not in the registry is known all the same, as a model's may be.
        also: how messages end that say which names there are, where ``others`` knows more.
    """

    registry: Registry[Any]
    made: type = object
    others: Callable[[str], bool] | None = None
    also: str = ""

    def __str__(self) -> str:
        return self.registry.kind

    def make(self, value: object, *, strict: bool = False) -> Any:
        """Return what a name or a mapping stands for; anything else is returned as it is.

        A name that only ``others`` knows stands for itself.
        With ``strict`` settings are converted as those of strict JSON are.

        Raises:
            FieldError: a mapping does not fit, at this field of it.
            ValueError: nothing has that name.
        """
        if isinstance(value, str):
            self.check(value)
            return self._made(value, {}, strict)
        if not isinstance(value, Mapping):
            return value
        settings = {key: setting for key, setting in value.items() if key != "name"}
        if "name" not in value:
            example = next((key for key in settings if key in self.registry), "NAME")
            raise FieldError("name", f"is missing: write {{name: {example}, SETTING: VALUE}}")
        name = value["name"]
        if not isinstance(name, str):
            raise FieldError("name", f"takes the name of a {self}, not {short_repr(name)}")
        try:
            self.check(name)
        except ValueError as error:
            raise FieldError("name", str(error)) from error
        return self._made(name, settings, strict)

    def check(self, name: str) -> None:
        """Refuse a name that nothing has.

        Raises:
            ValueError: the message lists the names there are.
        """
        try:
            self.registry[name]
        except KeyError as error:
            if self.others is None:
                raise ValueError(message_of(error)) from error
            if not self.others(name):
                raise ValueError(f"{message_of(error)}; {self.also}") from error

    def _made(self, name: str, settings: dict[str, object], strict: bool) -> Any:
        entry: Any = name
        if name in self.registry:
            entry = self.registry[name]
        if not (isinstance(entry, type) and issubclass(entry, BaseModel)):
            if settings:
                raise FieldError(next(iter(settings)), f"{self} {name} has no settings")
            return entry() if isinstance(entry, type) else entry
        try:
            if strict:
                return entry.model_validate_json(json.dumps(settings), strict=True)
            return entry.model_validate(settings)
        except ValidationError as error:
            raise FieldError(*first_problem(error, entry, settings)) from error

    def __get_pydantic_core_schema__(self, _source: object, _handler: GetCoreSchemaHandler) -> CoreSchema:
        """Validate and serialise what a parameter with this annotation is given."""
        return core_schema.with_info_plain_validator_function(
            self._validated,
            serialization=core_schema.plain_serializer_function_ser_schema(self._plain),
        )

    def _validated(self, value: object, info: core_schema.ValidationInfo) -> object:
        if isinstance(value, str):
            self.check(value)
            return value
        made = self.make(value, strict=info.mode == "json")
        if isinstance(value, Mapping) and not isinstance(made, BaseModel):
            return value["name"]
        if (info.mode == "json" and made is value) or not isinstance(made, self.made):
            raise ValueError(f"takes the name of a {self}, or {{name: NAME, SETTING: VALUE}}")
        return made

    def _plain(self, value: object) -> object:
        if isinstance(value, BaseModel):
            for name in self.registry:
                if self.registry[name] is type(value):
                    settings = value.model_dump(mode="json", exclude_defaults=True)
                    return {"name": name, **settings}
        return value
