"""The lists of objects that TDMS segments hand on: which channels the raw data hold, and what each last looked like."""

from __future__ import annotations

from typing import Any, BinaryIO, NamedTuple

from thermodata_reader_crio.tdms.segments.chunk_layout import DamageError, Layout, RawIndex, check
from thermodata_reader_crio.tdms.segments.index import CLOCK, ClockChange, Index
from thermodata_reader_crio.tdms.segments.lead_in import BIG_ENDIAN, INTERLEAVED, META, NEW_LIST, LeadIn, read_metadata
from thermodata_reader_crio.tdms.segments.metadata import SAME, Object, Properties, parse

# what says which values the numbers stand for
_MEANING = ("NI_Scal", "NI_Number_Of_Scales", "unit_string", "NI_UnitDescription")
_MEMO_BYTES = 8 * 1024 * 1024
_MOST_IDS = 500_000  # entries of the lists that are remembered
_Members = tuple[tuple[str, RawIndex], ...]


class Plan(NamedTuple):
    """What a segment's metadata would change. found: its objects, () where they are known to change nothing."""

    members: _Members
    active: dict[str, bool]
    active_id: int
    found: list[Object]
    key: tuple[int, int, int, bytes] | None = None
    spare: int = 0
    start: int = 0


class ObjectLists:
    """The current list of objects, each object's last index, and the layouts that came of them."""

    def __init__(self, index: Index) -> None:
        self.index = index
        self._active: dict[str, bool] = {}
        self._last: dict[str, RawIndex] = {}
        self._members: _Members | None = None
        self._generation = 0
        self._layouts: dict[Layout, int] = {}
        self._quick: dict[tuple[int, int], tuple[_Members, int]] = {}
        self._active_ids: dict[tuple[tuple[str, bool], ...], int] = {}
        self._active_id = self._next_id = self._ids_size = 0
        self._memo: dict[tuple[int, int, int, bytes], Plan] = {}
        self._memo_bytes = 0
        # the last list of properties that a new object had, and what came of it: the next one has mostly the same
        self._first: tuple[Properties, dict[str, Any], list[ClockChange]] = (), {}, []
        self._own: set[str] = set()  # objects whose properties no other shares

    def forget(self) -> None:
        """After a loss: only what the next segment names itself is known."""
        self._active, self._last, self._active_id, self._members = {}, {}, 0, None
        self._generation += 1

    def plan(self, file: BinaryIO, lead: LeadIn) -> Plan:
        """The plan of a segment whose metadata still stand in the file."""
        if not lead.toc & META:
            return self.plan_of(lead, None)
        data = read_metadata(file, lead)
        # Loggers repeat their metadata in each of many thousand segments; what is known is not parsed again.
        # The key is all that a parse depends on, so long as it changes no index and no property.
        key = (self._active_id, self._generation, lead.toc, data)
        known = self._memo.get(key)
        if known is not None:
            return known
        objects, used = parse(data, lead.order)
        spare = len(data) - used if data[used:].strip(b"\0") else 0
        return self.plan_of(lead, objects)._replace(key=key, spare=spare)

    def plan_of(self, lead: LeadIn, objects: list[Object] | None) -> Plan:
        """The plan of parsed metadata; None: the segment has none. Changes nothing yet."""
        if objects is None:
            if self._members is None:
                raise DamageError("a segment without metadata, and none before it")
            return Plan(self._members, self._active, self._active_id, [])
        active = {} if lead.toc & NEW_LIST else dict(self._active)
        fresh: dict[str, RawIndex] = {}
        for path, found, _ in objects:
            active[path] = found is not None
            if isinstance(found, RawIndex):
                fresh[path] = found
            elif found == SAME and path not in self._last and path not in fresh:
                raise DamageError(f"{path[:80]} repeats an index that it never had")
        members = tuple((path, fresh[path] if path in fresh else self._last[path]) for path, on in active.items() if on)
        return Plan(members, active, self._id_of(active), objects, start=lead.start)

    def _id_of(self, active: dict[str, bool]) -> int:
        """A number for a list of objects, for the memo; the same list may get a new one, never another the same."""
        self._ids_size += len(active)
        if self._ids_size > _MOST_IDS:
            self._active_ids.clear()
            self._ids_size = len(active)
        self._next_id += 1
        return self._active_ids.setdefault(tuple(active.items()), self._next_id)

    def layout(self, plan: Plan, toc: int) -> int:
        """The number of a plan's layout, as the flags of its segment have it; DamageError for one that can't be."""
        flags = toc & (INTERLEAVED | BIG_ENDIAN)
        quick = self._quick.get((id(plan.members), flags))
        if quick is not None:
            return quick[1]
        if len(self._quick) > 256:
            self._quick.clear()
        layout = Layout(plan.members, bool(toc & INTERLEAVED), bool(toc & BIG_ENDIAN))
        number = self._layouts.get(layout, -1)
        if number < 0:
            check(layout)
            number = self._layouts[layout] = len(self.index.layouts)
            self.index.layouts.append(layout)
            for path, index in layout.objects if layout.daqmx else ():
                if any(index.n < layout.buffers[scaler.buffer][0] for scaler in index.scalers):
                    self.index.note(f"{path[:80]} has fewer values in a chunk than the DAQmx buffer that it shares")
        # the entry keeps the tuple alive, so that its id stays its own
        self._quick[id(plan.members), flags] = plan.members, number
        return number

    def commit(self, plan: Plan) -> None:
        """Takes a plan over: its list, and the properties that it sets."""
        before = self._generation
        for path, found, properties in plan.found:
            if isinstance(found, RawIndex) and self._last.get(path) != found:
                self._last[path] = found
                self._generation += 1
            self._set_properties(path, properties)
        self._members, self._active, self._active_id = plan.members, plan.active, plan.active_id
        if plan.spare:
            self.index.note(f"byte {plan.start}: {plan.spare} bytes of metadata that belong to no object")
        if plan.key is not None and plan.found and self._generation == before:
            self._remember(plan, plan.key)

    def _set_properties(self, path: str, properties: Properties) -> None:
        known = self.index.properties.get(path)
        if known is None:
            self._set_first(path, properties)
            return
        changed = {}
        for name, value in properties:
            if name not in known or known[name] != value:
                self._generation += 1
                if path not in self._own:
                    self._own.add(path)
                    known = self.index.properties[path] = dict(known)
                if name in known and len(self.index.pieces) and name.startswith(_MEANING):
                    self.index.meanings.setdefault(path, f"{name}, '{known[name]}' and then '{value}'"[:200])
                known[name] = value
                if name in CLOCK:
                    changed[name] = value
        if changed:
            self.index.clock_changes.setdefault(path, []).append(ClockChange(len(self.index.pieces), changed))

    def _set_first(self, path: str, properties: Properties) -> None:
        """The first properties of an object: shared with those before it that had the same, until one changes."""
        piece = len(self.index.pieces)
        before, known, changes = self._first
        if properties is not before or (changes and changes[0].piece != piece):
            known = dict(properties)
            if len(known) < len(properties):
                # one that is named twice changes within the list
                self.index.properties[path] = {}
                self._own.add(path)
                self._set_properties(path, properties)
                return
            clock = {name: value for name, value in properties if name in CLOCK}
            changes = [ClockChange(piece, clock)] if clock else []
            self._first = properties, known, changes
        self._generation += len(known)
        self.index.properties[path] = known
        if changes:
            self.index.clock_changes[path] = changes.copy()

    def _remember(self, plan: Plan, key: tuple[int, int, int, bytes]) -> None:
        size = len(key[3])
        if size > _MEMO_BYTES // 8:
            return
        self._memo_bytes += size
        if self._memo_bytes > _MEMO_BYTES:
            self._memo.clear()
            self._memo_bytes = size
        self._memo[key] = plan._replace(found=[], key=None, spare=0)
