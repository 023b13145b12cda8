"""The parsers of the language, one door to all of them."""

from __future__ import annotations

from tamp.symbolic.pddl.domains import Undeclared as Undeclared
from tamp.symbolic.pddl.domains import parse_domain as parse_domain
from tamp.symbolic.pddl.streams import output_types as output_types
from tamp.symbolic.pddl.streams import parse_streams as parse_streams
from tamp.symbolic.pddl.tasks import parse_facts as parse_facts
from tamp.symbolic.pddl.tasks import parse_goal as parse_goal
from tamp.symbolic.pddl.tasks import parse_task as parse_task
