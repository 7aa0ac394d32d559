"""Values chosen by name: registered objects, with or without settings."""

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
    """Annotates a parameter that takes a registered object by name, alone or with settings.

    With ``Annotated[str | Mapping[str, object] | ShotRater, ByName(RATERS, ShotRater)]`` a file may say
    ``expected_goal`` or ``{name: expected_goal, threshold: 0.8}``, and Python may give a rater as well.
    An object with settings is registered as a pydantic model with these fields. Validation turns a mapping
    into the model; a name stays a name, also in a mapping if the object has no settings.

    Args:
        registry: the registry of known names.
        made: type of the built objects.
        others: returns whether a name that is not in the registry is known, such as a model's name.
        also: end of messages that list the known names, if ``others`` knows more.
    """

    registry: Registry[Any]
    made: type = object
    others: Callable[[str], bool] | None = None
    also: str = ""

    def __str__(self) -> str:
        return self.registry.kind

    def make(self, value: object, *, strict: bool = False) -> Any:
        """Return the object for a name or a mapping; anything else is returned unchanged.

        A name known only to ``others`` is returned unchanged. With ``strict`` settings are converted as those
        of strict JSON are.

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
        """Refuse an unknown name.

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
