"""Options as frozen dataclasses: read from a command line by tyro, with rules beside the fields."""

from __future__ import annotations

import contextlib
import functools
import inspect
import io
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from types import UnionType
from typing import Annotated, Any, TypeVar, get_args, get_origin, get_type_hints

import tyro

from tamp.errors import InputError

CONFIG = (tyro.conf.FlagCreatePairsOff,)
"""How tyro reads all commands: a flag has no --no-flag beside it."""

_RESOLVER: Any = tyro._resolver
_ask_typeguard = _RESOLVER.is_instance


def _is_instance(typ: Any, value: Any) -> bool:
    """Answer tyro about defaults without typeguard, which imports asyncio and more: 0.05 s.

    Of a default that there is not tyro takes no heed of the answer.
    """
    if tyro._singleton.is_sentinel(value):
        return False
    if isinstance(typ, UnionType):
        return any(_is_instance(one, value) for one in get_args(typ))
    if get_origin(typ) is tuple and get_args(typ)[1:] == (...,):
        return isinstance(value, tuple) and all(_is_instance(get_args(typ)[0], v) for v in value)
    return _ask_typeguard(typ, value)


_RESOLVER.is_instance = _is_instance

Options = TypeVar("Options")
Note = TypeVar("Note")


@dataclass(frozen=True)
class Above:
    """A rule: an option's number is above a limit; it stands in the option's annotation.

    Attributes:
        limit: The largest number that is refused.
        message: What is said of such a one, with `{value}` in it.
    """

    limit: float
    message: str

    def check(self, value: Any) -> None:
        """Refuse a value.

        Raises:
            InputError: It is not above the limit, or no number.
        """
        if not value > self.limit:
            raise InputError(self.message.format(value=value))


@dataclass(frozen=True)
class Between:
    """A rule: an option's number is within limits, both allowed.

    Attributes:
        low: The smallest.
        high: The largest.
        message: What is said of another one, with `{value}` in it.
    """

    low: float
    high: float
    message: str

    def check(self, value: Any) -> None:
        """Refuse a value.

        Raises:
            InputError: It is not within the limits.
        """
        if not self.low <= value <= self.high:
            raise InputError(self.message.format(value=value))


@dataclass(frozen=True)
class OneOf:
    """A rule: an option's value is one of some names.

    Attributes:
        what: What they are names of.
        choices: The names.
    """

    what: str
    choices: tuple[str, ...]

    def check(self, value: Any) -> None:
        """Refuse a value.

        Raises:
            InputError: It is none of the names.
        """
        if value not in self.choices:
            raise InputError(f"unknown {self.what} '{value}'", found=value, choices=self.choices)


def check_rules(options: Any) -> None:
    """Check every option that was given against the rules in its annotation.

    Raises:
        InputError: A value that a rule does not allow.
    """
    for option in _annotated(type(options)):
        value = getattr(options, option.field)
        for rule in option.notes:
            if isinstance(rule, Above | Between | OneOf) and value is not None:
                rule.check(value)
        if is_dataclass(value) and not isinstance(value, type):
            check_rules(value)


def changed(options: Any, kind: type[Note]) -> Iterator[tuple[str, Note]]:
    """Find the options that are not as usual and have a note of this kind in their annotation.

    Yields:
        The option's name, such as `--html`, and the note.
    """
    usual = {field.name: field.default for field in fields(options)}
    for option in _annotated(type(options)):
        for note in option.notes:
            if isinstance(note, kind) and getattr(options, option.field) != usual[option.field]:
                yield option.name, note


def read_options(
    kind: type[Options], program: str, arguments: Sequence[str] | None, more: str = ""
) -> Options:
    """Read the words of a command line by tyro.

    Args:
        kind: A frozen dataclass with a docstring a field; what its own docstring says is the help's
            head.
        program: The command's name.
        arguments: The words; None for those of the process.
        more: What the help says below that head.

    Raises:
        InputError: Something that the command does not know, in one line.
        SystemExit: With 0, when the help was asked for and printed.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    _check_names(kind, words)
    description = f"{inspect.getdoc(kind)}\n\n{more}" if more else None
    return one_line_errors(
        lambda: tyro.cli(kind, prog=program, args=words, description=description, config=CONFIG),
        program,
    )


def read_command(
    commands: Mapping[str, type[Options]], program: str, arguments: Sequence[str]
) -> Options:
    """Read the words of a command line that begins with a command of its own, by tyro.

    Args:
        commands: The options by the command's name.
        program: The whole command's name.
        arguments: The words.

    Raises:
        InputError: Something that the command does not know, in one line.
        SystemExit: With 0, when the help was asked for and printed.
    """
    name, *words = arguments
    if name in commands:
        _check_names(commands[name], words, f"See {program} {name} --help")
    return one_line_errors(
        lambda: tyro.extras.subcommand_cli_from_dict(
            dict(commands),
            prog=program,
            args=list(arguments),
            config=CONFIG,
            sort_subcommands=False,
        ),
        f"{program} {name}",
    )


def one_line_errors(parse: Callable[[], Options], program: str) -> Options:
    """Parse by tyro; make what it complains about in its frame an error like all others.

    Raises:
        InputError: What tyro says, in one line.
        SystemExit: With 0, when the help was asked for and printed.
    """
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            return parse()
    except SystemExit as end:
        if not end.code:  # --help
            raise
        raise InputError(sentence(complaint.getvalue()), remedy=f"See {program} --help") from None
    except BrokenPipeError:
        raise unread() from None


def unread() -> SystemExit:
    """End a command whose help nobody reads to its end (`--help | head`); Python must not flush the
    rest.
    """
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return SystemExit(0)


def sentence(box: str) -> str:
    """Find what tyro says in the first paragraph of its frame, in words of no programmer."""
    lines = [line.strip(" │|╭╮╰╯") for line in box.splitlines()]
    title, *said = [line for line in lines if line] or ["bad arguments"]

    paragraph: list[str] = []
    for line in said:
        if set(line) <= {"─", "-"}:
            if paragraph:
                break
            continue
        paragraph.append(line)
    text = " ".join(paragraph).removesuffix(" (required)").rstrip(".") or title
    text = text.removeprefix("Error parsing ")
    missing = re.fullmatch(r"Missing from [^:]+: ([A-Z|]+) (.+)", text)
    if missing is not None:
        text = f"expected {missing[1]}: {missing[2][0].lower()}{missing[2][1:]}"
    text = text.replace("invalid literal for int() with base 10:", "no whole number:")
    return text.replace("could not convert string to float:", "no number:")


@dataclass(frozen=True)
class _Option:
    """An option of a dataclass: its field, its name for the user, what its annotation holds."""

    field: str
    name: str
    notes: tuple[Any, ...]
    group: type | None


@functools.cache
def _annotated(kind: type) -> tuple[_Option, ...]:
    """List the fields of a dataclass of options; one that is a dataclass itself is a group."""
    options: list[_Option] = []
    for name, hint in get_type_hints(kind, include_extras=True).items():
        bare = get_args(hint)[0] if get_origin(hint) is Annotated else hint
        notes = getattr(hint, "__metadata__", ())
        group = bare if isinstance(bare, type) and is_dataclass(bare) else None
        options.append(_Option(name, f"--{name.replace('_', '-')}", notes, group))
    return tuple(options)


def _names(kind: type) -> Iterator[str]:
    """List the options that a user may give."""
    for option in _annotated(kind):
        if option.group is not None:
            yield from _names(option.group)
        elif tyro.conf.Positional not in option.notes:
            yield option.name


def _check_names(kind: type, words: Sequence[str], remedy: str = "") -> None:
    """Refuse an option that there is not, with the one that was probably meant."""
    given = [word.partition("=")[0].replace("_", "-") for word in words if word.startswith("--")]
    names = [*_names(kind), "--help"] if given else []
    for name in given:
        if name not in names:
            raise InputError(f"unknown option '{name}'", found=name, choices=names, remedy=remedy)
