"""The schema of a Parquet file with structs taken apart: a column for each value, and where it stands."""

from __future__ import annotations

from typing import Any


def check_types(file: Any) -> None:
    """ValueError where a column chunk is not of the type that the schema says: Arrow ends the process on it."""
    for group in range(file.metadata.num_row_groups):
        row_group = file.metadata.row_group(group)
        if row_group.num_columns != len(file.schema):
            raise ValueError(f"row group {group} has {row_group.num_columns} columns, the schema {len(file.schema)}")
        for column in range(row_group.num_columns):
            said, kind = file.schema.column(column).physical_type, row_group.column(column).physical_type
            if said != kind:
                raise ValueError(f"row group {group} column {column} is of {kind}, the schema says {said}")


def value_type(kind: Any) -> Any:
    """The type of a dictionary's values."""
    import pyarrow.types as pt

    return kind.value_type if pt.is_dictionary(kind) else kind


# a column, and the parts of a struct below it: names may themselves hold dots ("Temp. Motor [degC]")
Place = tuple[str, ...]


def flat(schema: Any) -> tuple[Any, list[Place]]:
    """The schema with structs taken apart, and the place of each column; lists and maps are left out."""
    import pyarrow as pa
    import pyarrow.types as pt

    fields: list[Any] = []
    places: list[Place] = []

    def add(field: Any, place: Place, name: str, depth: int) -> None:
        if pt.is_struct(field.type) and depth < 8:
            for inner in field.type:
                add(inner, (*place, inner.name), f"{name}/{inner.name}", depth + 1)
        elif not pt.is_nested(field.type):
            fields.append(pa.field(name, field.type, metadata=field.metadata))
            places.append(place)

    for field in schema:
        add(field, (field.name,), field.name, 0)
    return pa.schema(fields), places


def left_out(schema: Any) -> list[str]:
    """A note on columns of lists and maps, which are not read; none where there are none."""
    import pyarrow.types as pt

    names = [f.name for f in schema if pt.is_nested(f.type) and not pt.is_struct(f.type)]
    return [f"columns of lists are not read: {', '.join(names[:8])}"] if names else []


def column_at(batch: Any, place: Place) -> Any:
    """A column, or a part of a struct."""
    import pyarrow.compute as pc

    column = batch.column(batch.schema.names.index(place[0]))
    for name in place[1:]:
        column = pc.struct_field(column, name)
    return column
