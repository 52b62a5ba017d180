"""What a label file says of a user's own meshes (docs/catalogue.md)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from shared.errors import InvalidInput

Finite = Annotated[float, Field(allow_inf_nan=False)]


class MeshLabel(BaseModel):
    """One object of a label file.

    Attributes
    ----------
    file : str
        The mesh, relative to the label file or to the folder `meshes` beside it.
    scale : float
        Metres per unit of the mesh.
    regions : dict
        Task -> (axis, side, value): the half-space to hold, in the mesh's units.
    class_name : str
        What it is; `class` in the file.
    description : str
        In words.
    not_afforded : tuple of str
        Tasks that the object clearly cannot serve.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    file: str
    scale: float = Field(default=1.0, gt=0, allow_inf_nan=False)
    regions: dict[str, tuple[Literal["x", "y", "z"], Literal["<", ">"], Finite]] = Field(
        min_length=1
    )
    class_name: str = Field(default="", alias="class")
    description: str = ""
    not_afforded: tuple[str, ...] = ()


def read_labels(labels: Path, split: str | None = None) -> dict[str, MeshLabel]:
    """Return what a label file says, without reading the meshes.

    Raises
    ------
    InvalidInput
        The file is missing or no JSON, there is no such split, or a label is malformed.
    """
    try:
        content = json.loads(labels.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidInput(f"the label file {labels} cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        raise InvalidInput(f"the label file {labels} is not JSON: {error}") from None
    splits = (
        {key: value for key, value in content.items() if isinstance(value, dict)}
        if isinstance(content, dict)
        else {}
    )
    if not splits:
        raise InvalidInput(f"{labels} has no objects: it must be {{split: {{name: object}}}}")
    if split is not None and split not in splits:
        raise InvalidInput(f"{labels} has no split {split!r}; it has {', '.join(splits)}")
    found: dict[str, MeshLabel] = {}
    for key in splits if split is None else [split]:
        for name, entry in splits[key].items():
            if name in found:
                raise InvalidInput(f"{labels} has two objects of the name {name!r}")
            try:
                found[name] = MeshLabel.model_validate(entry)
            except ValidationError as error:
                first = error.errors(include_url=False)[0]
                where = ".".join([key, name, *map(str, first["loc"])])
                raise InvalidInput(
                    f"{labels}: {where}: {first['msg']}, found {first['input']!r}"
                ) from None
    return found
