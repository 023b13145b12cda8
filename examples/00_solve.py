"""Plan a shipped problem and look at the plan.

`load_problem` takes the name of a shipped problem or a path; `solve` returns a `Solution`, whose outcome says whether
there is a plan, and if not, why.
"""

import tamp

problem = tamp.load_problem("one_object")
solution = tamp.solve(problem, max_time=30.0, seed=0)
print(solution.outcome.value)

for action in solution.plan:  # empty when there is none
    print(f"{action.start:5.1f} s", action.name, *action.objects)

tamp.write_plan(solution, "plan.json")  # tamp-verify plan.json checks it with another engine
