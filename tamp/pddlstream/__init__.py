"""Problems written for PDDLStream: its domain and stream texts, a map of Python functions, facts as
nested tuples.

solution = solve(PDDLProblem(domain_pddl, constant_map, stream_pddl, stream_map, init, goal))
"""

from tamp.pddlstream.adapters import WildOutput as WildOutput
from tamp.pddlstream.adapters import empty_gen as empty_gen
from tamp.pddlstream.adapters import from_constant as from_constant
from tamp.pddlstream.adapters import from_fn as from_fn
from tamp.pddlstream.adapters import from_gen as from_gen
from tamp.pddlstream.adapters import from_gen_fn as from_gen_fn
from tamp.pddlstream.adapters import from_list_fn as from_list_fn
from tamp.pddlstream.adapters import from_list_gen_fn as from_list_gen_fn
from tamp.pddlstream.adapters import from_sampler as from_sampler
from tamp.pddlstream.adapters import from_test as from_test
from tamp.pddlstream.problem import PDDLProblem as PDDLProblem
from tamp.pddlstream.solve import Action as Action
from tamp.pddlstream.solve import Solution as Solution
from tamp.pddlstream.solve import solve as solve
