"""How a macro finds its files: names are looked up in constant maps, and `query` runs the text that they give.

A table macro can't look its files up in a table, but DuckDB folds a lookup in a constant map before it opens
anything: one file is opened instead of a thousand (4 ms instead of 20). Names reach the text only as literals.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from thermodata.schema.words.sentences import with_count
from thermodata.store.base.connection import literal, quoted
from thermodata.store.views.catalogue import Catalogue, Group
from thermodata.store.views.wide import file_list

_SHOWN = 30


def lookup_macros(catalogue: Catalogue, tests: Mapping[str, Iterable[str]]) -> Iterator[str]:
    """Scalar macros: `sql_text` quotes, `files_<group>` and `known_<campaign>` give arguments as SQL text,
    `named_<campaign>` the tests that one name, a list of them, or null means."""
    yield ("create macro sql_text(x) as coalesce('''' || replace(cast(x as varchar), '''', '''''') || '''', 'null')")
    for group in catalogue.groups:
        entries = ", ".join(
            f"{literal(test)}: {literal(file_list(paths) + ', true')}" for test, paths in group.paths.items()
        )
        # a test without this stream reads no row of another test's file
        fallback = literal(file_list([group.files[0]]) + ", false")
        yield (
            f"create macro {quoted('files_' + group.name)}(test) as "
            f"coalesce((map {{{entries}}})[cast(test as varchar)], {fallback})"
        )
    for campaign, suffix in catalogue.campaigns.items():
        names = sorted(tests.get(campaign, ()))
        refusal = refuse("no test ", "test", f" in campaign '{campaign}'", names)
        yield (
            f"create macro {quoted('known_' + suffix)}(test) as case when list_contains("
            f"{file_list(names)}::varchar[], cast(test as varchar)) then sql_text(test) else {refusal} end"
        )
        # a list reaches the text as its text; a test that stands in it twice is one test
        every = file_list(names)
        of_list = "list_transform(cast(cast(test as varchar) as varchar[]), lambda one: coalesce(one, 'NULL'))"
        yield (
            f"create macro {quoted('named_' + suffix)}(test) as case when test is null then {every}::varchar[] "
            f"when list_contains({every}::varchar[], cast(test as varchar)) then [cast(test as varchar)] "
            f"else list_sort(list_distinct({of_list})) end"
        )


def files_call(group: Group) -> str:
    """The text of two arguments, a list of files and whether they are the test's, for `from_files`."""
    return f"{quoted('files_' + group.name)}(test)"


def from_files(files: str, own: str) -> str:
    """A FROM item over the two arguments of `files_call`."""
    return f"(select * from read_parquet({files}, hive_partitioning = false) where {own}) r"


def of_each_test(catalogue: Catalogue, campaign: str, text: str) -> str:
    """The text of a query over every test that the macro parameter `test` names. text: SQL over `test` that gives the
    text of one."""
    suffix = catalogue.campaigns[campaign]
    each = f"list_transform({quoted('named_' + suffix)}(test), lambda test: {text})"
    none = literal("no test is named: one, a list of them, or null for all")
    return f"coalesce(nullif(array_to_string({each}, ' union all '), ''), error({none}))"


def known_call(catalogue: Catalogue, campaign: str) -> str:
    """The text of the macro parameter `test` as a literal, or an error that names the campaign's tests."""
    return f"{quoted('known_' + catalogue.campaigns[campaign])}(test)"


def dispatcher(
    catalogue: Catalogue,
    name: str,
    parameters: Mapping[str, str | None],
    texts: Mapping[str, str | None],
    empty: str,
    several: Mapping[str, str] | None = None,
) -> Iterator[str]:
    """The table macro `name(campaign, parameters...)`: it runs the text that the campaign's expression gives.

    parameters: name -> default, or None. texts: campaign -> SQL over the parameters that gives the text of a
    query, or None for the `empty` query. several: campaign -> the same where `test` is a list or null. Two steps, so
    that only one campaign's maps are ever expanded, and once.
    """
    inner = ", ".join(parameters)
    outer = ", ".join(p if default is None else f"{p} := {default}" for p, default in parameters.items())
    passed = " || ', ' || ".join(f"sql_text({p})" for p in parameters)
    cases = []
    for campaign, text in texts.items():
        own = quoted(f"{name}_in_{catalogue.campaigns[campaign]}")
        yield f"create macro {own}({inner}) as table select * from query({text or literal(empty)})"
        called = literal(own)
        if several is not None and campaign in several:
            of_each = quoted(f"{name}_each_{catalogue.campaigns[campaign]}")
            yield f"create macro {of_each}({inner}) as table select * from query({several[campaign]})"
            called = f"case when cast(test as varchar) not like '[%]' then {called} else {literal(of_each)} end"
        cases.append(f"when {literal(campaign)} then 'select * from ' || {called} || '(' || {passed} || ')'")
    choice = (
        f"case cast(campaign as varchar) {' '.join(cases)} else {refuse('no campaign ', 'campaign', '', texts)} end"
        if cases
        else literal(empty)
    )
    yield f"create macro {quoted(name)}(campaign, {outer}) as table select * from query({choice})"


def refuse(before: str, parameter: str, after: str, choices: Iterable[str]) -> str:
    """An `error` call that names the choices."""
    names = list(choices)
    shown = with_count(names, _SHOWN)
    tail = f"'{after}; there is: {shown or 'none'}"
    return f"error({literal(before + chr(39))} || coalesce(cast({parameter} as varchar), 'NULL') || {literal(tail)})"
