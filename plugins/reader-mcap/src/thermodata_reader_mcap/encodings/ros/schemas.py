"""The decoder of a ROS schema: cdr (ROS 2, by ros2msg or ros2idl) and ros1 (by ros1msg)."""

from __future__ import annotations

from typing import Any

from thermodata_reader_mcap.container.definitions import Schema
from thermodata_reader_mcap.encodings.decoder import UnsupportedError
from thermodata_reader_mcap.encodings.ros.columns import RosColumns
from thermodata_reader_mcap.encodings.ros.idl import idl_types
from thermodata_reader_mcap.encodings.ros.message_types import LineError, TypeTextError, message_types
from thermodata_reader_mcap.encodings.ros.package import package_decoder


def ros_decoder(encoding: str, schema: Schema) -> Any:
    """The decoder of a ROS schema: ours, or the package's where our parser does not read it. UnsupportedError."""
    try:
        text = schema.data.decode("utf-8", "replace")
        if schema.encoding == "ros2idl":
            types = idl_types(schema.name, text)
        else:
            types = message_types(schema.name, text, encoding == "ros1")
        if types.root not in types.structs:
            raise TypeTextError(f"the type {types.root} is not defined")
    except (TypeTextError, RecursionError) as error:
        if schema.encoding == "ros2msg" and encoding == "cdr" and isinstance(error, LineError):
            theirs = package_decoder(schema)
            if theirs is not None:
                return theirs
        raise UnsupportedError(f"the schema '{schema.name}' does not read: {error}") from None
    return RosColumns(types, encoding == "ros1")
