"""Mutants of the parts that read text: numbers, times, rows, tables, and what is told of what does not read."""

from __future__ import annotations

from pathlib import Path

from mutant import Mutant

ROOT = Path(__file__).resolve().parents[2]
# the tests that stand beside a module
BESIDE = {
    "preamble/begin.py": ("head_start",),
    "cells/time_forms/clock_pattern.py": ("clock_pattern",),
    "times/one_cell/clock_letters.py": ("time_formats",),
    "tables/sample/columns.py": ("columns",),
    "times/several_cells/days.py": ("days",),
    "delimited.py": ("delimited",),
    "cells/lines/delimiter.py": ("delimiter",),
    "names/described.py": ("described",),
    "rows/footer.py": ("footer",),
    "file/foreign_texts.py": ("foreign_texts",),
    "rows/grid.py": ("three_ways", "rows_width"),
    "preamble/head_start.py": ("head_start",),
    "preamble/head_words.py": ("head_start",),
    "names/header.py": ("delimited",),
    "names/header_rows.py": ("preambles",),
    "page/first_data.py": ("delimited",),
    "page/layout.py": ("delimited",),
    "file/letters.py": ("letters",),
    "file/lines.py": ("lines", "locate"),
    "times/local_clock.py": ("local_clock",),
    "file/locate.py": ("locate",),
    "file/losses.py": ("losses", "delimited"),
    "cells/values/number.py": ("number",),
    "cells/values/column.py": ("number",),
    "cells/values/quotes.py": ("number", "quotes"),
    "clocks/odd_clocks.py": ("clock_pattern",),
    "rows/quality_columns.py": ("quality_columns",),
    "rows/odd_rows.py": ("three_ways", "rows_width"),
    "rows/typed.py": ("three_ways", "rows_width"),
    "tables/table.py": ("delimited",),
    "tables/blocks/group_rows.py": ("delimited",),
    "tables/blocks/table_rows.py": ("delimited",),
    "times/time_formats.py": ("time_formats",),
    "cells/time_forms/time_pattern.py": ("timestamp", "time_formats"),
    "times/one_cell/timestamp.py": ("timestamp",),
    "cells/time_forms/zone_words.py": ("timestamp",),
}


def text(file: str, old: str, new: str, why: str, *more: str) -> Mutant:
    """more: further topics whose tests are run."""
    beside = (next((ROOT / "tests/reader/text").rglob(f"test_{topic}.py")) for topic in (*BESIDE[file], *more))
    tests = tuple(path.relative_to(ROOT).as_posix() for path in beside)
    return Mutant(f"thermodata/reader/text/{file}", old, new, why, tests)


MUTANTS = [
    # ---- numbers
    text("cells/values/number.py", "EXACT = 2**53", "EXACT = 2**54", "integers are rounded"),
    text("cells/values/number.py", "abs(value) >= EXACT and", "abs(value) > EXACT and", "2**53 + 1 is read as 2**53"),
    text("cells/values/number.py", "math.isinf(value) or (", "(", "1e999 is infinite"),
    text("cells/values/number.py", "(declared and _ONE_GROUP", "(_ONE_GROUP", "1.500 is 1500 though nothing proves it"),
    text(
        "cells/values/number.py",
        "or (declared and _ONE_GROUP[decimal].fullmatch(text))",
        "",
        "a declared mark tells nothing",
    ),
    text(
        "cells/values/number.py",
        r"""(?:\.\d{3})+,\d+|(?:\.\d{3}){2,})", re.ASCII)""",
        r"""(?:\.\d{3})+,\d+)", re.ASCII)""",
        "1.234.567 is lost",
    ),
    text("cells/values/number.py", '[1-9]\\d{0,2},\\d{3}"', '\\d{1,3},\\d{3}"', "0,500 is five hundred"),
    text(
        "cells/values/column.py",
        "low in EMPTY, low in OVERLOAD",
        "low in EMPTY or low in OVERLOAD, False",
        "overload is nothing",
    ),
    text("cells/values/column.py", "if wrong and not over[i]:", "if wrong:", "overload is a loss"),
    text(
        "cells/values/number.py",
        "limits.min <= whole <= limits.max",
        "-(2**63) <= whole <= limits.max",
        "unsigned counters below 0",
    ),
    text("cells/values/number.py", "and abs(value) <= EXACT else", "else", "1e300 is an integer"),
    text(
        "cells/values/column.py",
        "if not (np.abs(values) < EXACT).all():",
        "if not (np.abs(values) <= 2 * EXACT).all():",
        "Arrow rounds",
    ),
    text("cells/values/column.py", r"-?\d{{1,15}}(?:", r"-?\d{{1,16}}(?:", "Arrow rounds integers of 16 digits"),
    text("cells/values/quotes.py", " or '\"' * (text.count('\"') % 2)", "", "a quote alone is an empty cell"),
    text("cells/values/number.py", "if points and commas:", "if False:", "files of two decimal marks are read by one"),
    text(
        "cells/values/column.py",
        "known[cell] = (nothing if value is None else value, value is None, beyond,",
        "known[cell] = (nothing if value is None else value, gone, beyond,",
        "a lost integer is 0",
    ),
    # ---- times
    text("times/one_cell/timestamp.py", "CENTURY = 69", "CENTURY = 80", "1970s are 2070s"),
    text(
        "times/one_cell/timestamp.py",
        'fields["y"] < CENTURY',
        'fields["y"] <= CENTURY',
        "a column has another century than its cells",
    ),
    text(
        "cells/time_forms/clock_pattern.py", "(0 if native else 1) <= hour <= 12", "0 <= hour <= 23", "13 PM is a time"
    ),
    text("cells/time_forms/clock_pattern.py", 'half[0] in "pP"', "False", "afternoons are mornings"),
    text(
        "cells/time_forms/zone_words.py",
        '(-1 if rest[0] == "-" else 1)',
        '(1 if rest[0] == "-" else -1)',
        "zones are turned",
    ),
    text(
        "times/one_cell/timestamp.py",
        "total -= offset_ns(groups",
        "total += offset_ns(groups",
        "zones are turned, in columns",
    ),
    text("cells/time_forms/zone_words.py", "int(minutes or 0) * 60)", "0)", "zones of half hours"),
    text(
        "times/one_cell/timestamp.py",
        '{"f": 9, "of": 6}[name]',
        '{"f": 6, "of": 6}[name]',
        "fractions are a thousandth",
    ),
    text(
        "times/one_cell/timestamp.py",
        'int(g["f"].ljust(9, "0"))',
        'int(g["f"].rjust(9, "0"))',
        "fractions without their zeros",
    ),
    text("times/one_cell/timestamp.py", "& ((year % 100 != 0) | (year % 400 == 0))", "", "a 29 February 2100"),
    text(
        "times/one_cell/timestamp.py",
        "    if not _has_colons(column):\n        return None\n",
        "",
        "torn times are whole hours",
    ),
    text("times/one_cell/timestamp.py", "int(ns.min()) >= _FIRST_NS and ", "", "years before 1900"),
    text(
        "times/one_cell/timestamp.py",
        'if form.body != DATETIME["ymd"].body or',
        "if form.pattern is None or",
        "a declared order of day and month is left out",
    ),
    text("times/one_cell/timestamp.py", ".body or form.zoned:", ".body:", "times without their zone among others"),
    text(
        "times/one_cell/timestamp.py",
        "        good &= matrix[:, place] == matrix[0, place]\n",
        "        pass\n",
        "what parts a time may be anything",
    ),
    text("times/one_cell/timestamp.py", "moment.tzinfo or UTC", "UTC", "a declared offset is left out"),
    text(
        "cells/time_forms/time_pattern.py",
        "(ZONE if zoned else",
        '(f"{ZONE}?" if zoned else',
        "local times among those of UTC",
    ),
    # ---- which letters a byte stands for
    text(
        "file/letters.py",
        "bool(of_west) - bool(of_east)",
        "bool(of_east) - bool(of_west)",
        "a Polish letter is a power",
    ),
    text("file/letters.py", "_UNPROVEN else 0.0)", "0.0 else 0.0)", "a letter that may be either is not asked"),
    text("file/letters.py", 'if len(word) == 1 and word != b"\\xe0":', "if False:", "a lone letter is no word"),
    text("file/letters.py", "total += 0.6 * math.log(", "total -= 0.6 * math.log(", "words speak against themselves"),
    text("file/letters.py", '_SIGNS.sub(b" ", data) if signs else data', "data", "a power is a Polish letter"),
    # ---- how times are written
    text(
        "times/time_formats.py",
        'return forms["dmy"]\n',
        'return forms["mdy"]\n',
        "month first though dots part it",
    ),
    text(
        "times/time_formats.py",
        'return replace(forms["mdy"]',
        'return replace(forms["dmy"]',
        "AM and PM with the day first",
    ),
    text("times/time_formats.py", "if shares[o] == best]", "]", "a day above 12 decides nothing"),
    text(
        "times/time_formats.py",
        "(partial(_spread_evenly, cells, _MANY), more)",
        "(partial(_spread_evenly, cells, _MANY),)",
        "a day far down decides nothing",
    ),
    text("times/time_formats.py", "zoned * 2 > len(some)", "zoned > 0", "one zone makes all local times bad"),
    text("times/time_formats.py", "_FEW, _MANY = 40, 4000", "_FEW, _MANY = 40, 40", "one day above 12 is not seen"),
    # ---- a start above the rows
    text("preamble/begin.py", "said.says < TimeLabel.RECORDED or not", "not", "the date of an export is the start"),
    text("preamble/begin.py", "or not first.near_zero)):", ")):", "rows that begin late count from the start"),
    text("preamble/begin.py", "if said.several or not first.ns:", "if not first.ns:", "of two starts one is taken"),
    text(
        "preamble/begin.py",
        "if said.either else (begin and replace",
        "if False else (begin and replace",
        "day and month are guessed",
    ),
    text(
        "preamble/begin.py", "if said.either and declared is not None:", "if False:", "head answers day and month, too"
    ),
    text(
        "preamble/begin.py",
        "return not first.near_zero\n",
        "return first.ns[0] != 0\n",
        "a duration begins at midnight",
    ),
    text(
        "preamble/begin.py",
        "return None, _NOTHING.format(declared)",
        "return None, None",
        "a start that is not there is silent",
    ),
    text(
        "preamble/head_words.py",
        "if TimeLabel.MADE in known else",
        "if False else",
        "a word for a start outdoes an export",
    ),
    text("preamble/head_words.py", "any(w not in _WORDS for w in words)", "False", "a calibration is a start"),
    text("preamble/head_start.py", "min(low, TimeLabel.BARE)", "high", "a duration is a time of day"),
    # ---- days and midnights
    text(
        "times/several_cells/days.py",
        "-DAY_NS // 2) & over)",
        "-DAY_NS // 2))",
        "a clock that is set back passes midnight",
    ),
    text(
        "times/several_cells/days.py",
        "steps < -_SET_NS",
        "steps < -DAY_NS // 2",
        "a log that goes on next morning goes back in time",
    ),
    text("times/several_cells/days.py", "steps < -_SET_NS", "steps < 0", "the hour that repeats passes midnight"),
    text(
        "times/several_cells/days.py", "elif self._sound or empty[k]:", "else:", "a date that changes early moves a day"
    ),
    text(
        "times/several_cells/days.py",
        "bool(away[k]) or count > 0, 0",
        "bool(away[k]), count",
        "a new date keeps the midnights before it",
    ),
    text(
        "times/several_cells/days.py",
        "2) | paused)",
        "2))",
        "of a session that begins later in the day no midnight is counted",
    ),
    text("cells/time_forms/clock_pattern.py", "0 if native else 1", "0", "0:30 a. m. is a time"),
    text("cells/time_forms/clock_pattern.py", "hour % 12 + (", "hour + (", "noon is midnight"),
    text("clocks/odd_clocks.py", "if len(columns) != 1:", "if True:", "days that many rows share stand at midnight"),
    text(
        "clocks/odd_clocks.py", "if _is_shaped(i, seen.rows)", "if True", "the number of a part is offered as the time"
    ),
    # ---- clocks
    text("times/local_clock.py", "(ahead < -self._cycle // 2)", "(ahead < 0)", "each step back is a midnight"),
    text("times/local_clock.py", "_DAY = 24 *", "_DAY = 12 *", "days have twelve hours"),
    text("times/local_clock.py", "nights = self._nights + ", "nights = ", "midnight is forgotten with the next part"),
    text(
        "times/local_clock.py",
        "            self._before = joined[far[-1] if far.size else 0 :]\n",
        "",
        "the hour that repeats is not told across parts",
    ),
    # ---- rows
    text("rows/typed.py", "np.fmax.reduce(values) >= EXACT or ", "", "large integers are rounded"),
    text("rows/typed.py", "np.fmin.reduce(values) <= -EXACT", "False", "large negative integers are rounded"),
    text(
        "rows/typed.py",
        "lines = np.arange(line, line + table.num_rows, dtype",
        "lines = np.arange(line + 1, line + 1 + table.num_rows, dtype",
        "rows stand a line too low",
    ),
    text("rows/typed.py", "np.array([row.number - 1 for", "np.array([row.number for", "lines move behind a bad one"),
    text("rows/odd_rows.py", "not self.grid.exact and ", "", "a delimiter too much shifts cells"),
    text("rows/grid.py", ", short=self.short[np.isin(self.short, line)]", "", "empty lines lack a group"),
    text("rows/odd_rows.py", "            self.short.append(line)\n", "", "rows that lack a group go unnoticed"),
    text(
        "rows/odd_rows.py", "        at += more\n", "        at += 1\n", "the lines of a cell in quotes are rows again"
    ),
    text("rows/typed.py", 'b"\\0" in data\n        or', "False\n        or", "bytes of zero are parts of cells"),
    text(
        "rows/odd_rows.py",
        "if len(_cells(joined, grid)) == grid.width:",
        "if True:",
        "a quote left open takes rows with it",
    ),
    text("rows/typed.py", "if table.num_rows != many:", "if False:", "cells over lines move the lines"),
    # ---- tables
    text("tables/sample/columns.py", "2 * words >= len(full)", "2 * words > len(full)", "half words are numbers"),
    text("tables/sample/columns.py", "max(1, 0.02 *", "max(3, 0.02 *", "comments are numbers"),
    text("tables/sample/columns.py", "0.02 * len(full)", "0.2 * len(full)", "comments are numbers"),
    text("tables/sample/columns.py", "EXACT < most < 2**63", "EXACT < most", "integers that no int64 holds"),
    text(
        "tables/sample/columns.py",
        "if all(_GROUPED.fullmatch(c) for c in commas):",
        "if False:",
        "thousands are fractions",
    ),
    text("cells/lines/delimiter.py", "share >= 0.5", "share >= 0.1", "prose is a table"),
    text("cells/lines/delimiter.py", "share > best[0] + 0.2", "share > best[0]", "a decimal comma delimits"),
    text(
        "cells/lines/delimiter.py", "body = body[len(body) // 3 :]", "body = body[:]", "a preamble tells the delimiter"
    ),
    text("cells/lines/delimiter.py", "or line.count('\"') % 2", "", "a quote left open swallows delimiters"),
    text("page/first_data.py", " and following[0] not in body[:i]", "", "a row above a repeated header is lost"),
    text("tables/blocks/group_rows.py", "rows.line[good] + 1)\n", "rows.line[good])\n", "a trace shows the line above"),
    text(
        "tables/blocks/group_rows.py",
        "cells.over * _OVER if cells.over.any() else None",
        "None",
        "overload is not flagged",
    ),
    text(
        "tables/blocks/group_rows.py",
        "(cells.empty & ~cells.over) * _NONE",
        "cells.empty * _NONE",
        "overload is not measured",
    ),
    text(
        "tables/blocks/table_rows.py",
        "return line in self._anew or repeats_header(self.table, text, under)",
        "return line in self._anew",
        "repeated headers are losses",
    ),
    text("tables/blocks/table_rows.py", "        self.stopped = True\n", "", "two tables are one"),
    text(
        "tables/blocks/table_rows.py",
        "rows, lost = rows.before(found.line), [",
        "rows, lost = rows, [",
        "rows of another table are read",
    ),
    text(
        "tables/blocks/table_rows.py", "waiting[waiting < last_whole]", "waiting[:0]", "torn rows of groups are no loss"
    ),
    text(
        "tables/blocks/table_rows.py",
        "self.grid, self.sure = replace(self.grid, decimal=other), True",
        "self.sure = True",
        "fractions far down are lost",
    ),
    text(
        "tables/blocks/group_rows.py",
        "                if good[row]:\n",
        "                if True:\n",
        "a lost row is lost again by its cells",
    ),
    text("tables/blocks/table_rows.py", "elif tail.strip(", "elif False and tail.strip(", "a torn end is no loss"),
    text("tables/table.py", '.strip("\\ufeff")', "", "joined files end at the second header"),
    text("tables/table.py", "            exact=True,\n", "", "a delimiter too much shifts cells"),
    text(
        "tables/table.py", "            decimal_declared=self.decimal_declared,\n", "", "the declared mark is left out"
    ),
    # ---- what stands above and below the rows
    text(
        "names/header_rows.py",
        "and of_units(below[0], times) and unnamed",
        "and of_units(below[0], times)",
        "names are comments",
    ),
    text(
        "names/header_rows.py",
        "[n or a for n, a in zip(row, above",
        "[n for n, a in zip(row, above",
        "merged names are lost",
    ),
    text("names/described.py", "len(set(said.values())) < len(said)", "False", "a kind of input is a name"),
    text("names/described.py", "    rows = rows[:at]\n", "", "a comment on sensors is a name"),
    text("names/described.py", "max(_FEWEST, len(names) // 2)", "1", "a comment on the file describes a channel"),
    text("rows/footer.py", "numbers = all(", "numbers = True or all(", "damage behind a word is no loss"),
    text("rows/footer.py", "(bool(others) and _STATISTIC", "(_STATISTIC", "a word alone is statistics"),
    text("file/foreign_texts.py", "not cut and all(words)", "all(words)", "a program is a print"),
    text(
        "times/one_cell/clock_letters.py",
        "if not full or share(full, form):",
        "if not full:",
        "damage refuses a declared format",
    ),
    text(
        "times/one_cell/clock_letters.py",
        'f"{found[\'mark\']}%f" if found["mark"] else ""',
        '""',
        "fractions are not proposed",
    ),
    text("file/losses.py", "NAMED = 20", "NAMED = 10", "half of the losses have no line"),
    text("file/losses.py", "line {line + 1}", "line {line}", "losses name the line above"),
    text("file/losses.py", "if not self._more:", "if True:", "losses beyond the twentieth are not told"),
    text("file/losses.py", "0 < each.row <= t_ns.size", "0 <= each.row < t_ns.size", "losses are dated a row off"),
    text("file/locate.py", "int(item.at[row - done])", "int(item.at[row])", "rows of a later block are somewhere else"),
    text(
        "file/locate.py",
        "behind = item.at[item.at > here]",
        "behind = item.at[item.at >= here]",
        "lines end where they begin",
    ),
    text(
        "rows/quality_columns.py",
        "zeros[word] = bool(told(zero_is_good((c for name in own for c in columns[name]), word), own[0]))",
        "zeros[word] = True",
        "classic OPC's bad is good",
    ),
    text(
        "rows/quality_columns.py",
        "[0 if _keeps(str(word), zero, name) else BAD",
        "[BAD if _keeps(str(word), zero, name) else 0",
        "good values are bad",
    ),
    # ---- lines
    text("file/lines.py", 'line += count(part, b"\\n")', "line += 1", "lines move with each chunk"),
    text("file/lines.py", "odd.append(first + k)", "odd.append(k)", "odd bytes are told of other lines"),
    text("file/lines.py", "data.removeprefix(codecs.BOM_UTF8)", "data", "the first name begins with a mark"),
    text("file/lines.py", "if mac:\n", "if False:\n", "lines that end with CR are one"),
    text("file/lines.py", "if fields[0] and fields[0] == fields[1]:", "if fields[0]:", "a cut number is a value"),
    text("file/lines.py", "digits[0] >= digits[1] > 0", "digits[0] >= 0", "a cut fraction is a value"),
    text(
        "file/lines.py",
        "decoder.decode(data, final=last)",
        "decoder.decode(data, final=True)",
        "letters are torn where chunks meet",
    ),
]
