"""A command line whose mistakes are errors like all others: one line."""

from __future__ import annotations

import argparse
from typing import NoReturn

from tamp.errors import InputError


class Parser(argparse.ArgumentParser):
    """Argparse's, but that it raises InputError instead of printing how the command is used."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong.

        Raises:
            InputError: Always.
        """
        raise InputError(message, remedy=f"See {self.prog} --help")
