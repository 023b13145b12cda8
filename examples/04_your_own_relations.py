"""Your own relations: `near`, written in Python, and `lying`, learned from a dozen demonstrations.

The domain `kitchen/kitchen.pddl` is the cupboard's with these two relations more; `kitchen/lying` has the
demonstrations: problem files whose goals say what lies and what does not. docs/adding-a-predicate.md explains it all.
"""

import tempfile
from pathlib import Path

import tamp
from grounding.collect import collect, read_demonstrations
from grounding.registry import load_grounding
from grounding.train import train
from grounding.weights import write_weights
from tamp.geometric.samplers.python_file import python_grounding

HERE = Path(__file__).parent / "kitchen"

data = collect("lying", read_demonstrations("lying", [HERE / "lying"]))
print(f"{len(data)} demonstrations, {data.holds.sum()} of them positive")
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "lying.safetensors"
    write_weights(file, train(data, "transfer"))
    lying = load_grounding(file)

near = python_grounding(HERE / "near.py")  # or an object of a class that is defined here

problem = tamp.load_problem(HERE / "kitchen.yaml", groundings={"lying": lying, "near": near})
solution = tamp.solve(problem, max_time=30.0, seed=0)
print(solution.outcome.value)
for action in solution.plan:
    print(action.name, *action.objects)
