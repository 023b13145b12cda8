#!/usr/bin/env bash
# OMPL: a state that is not a number lies within any bounds.
#
# Expected: satisfiesBounds(state) is False for a NaN coordinate, so that testing a start and a goal with it before
# planning keeps broken numbers out.
#
# Seen 2026-11-29 with ompl 2.0.1, Python 3.11, Linux x86-64: True in a RealVectorStateSpace with bounds [-1, 1], for NaN in
# any coordinate; infinity and 2.0 are refused. enforceBounds leaves NaN as it is.
source "$(dirname "$(realpath "$0")")/prelude"
install ompl==2.0.1
cat > look.py <<'PYTHON'
import math

from ompl import base as ob

space = ob.RealVectorStateSpace(2)
bounds = ob.RealVectorBounds(2)
bounds.setLow(-1.0)
bounds.setHigh(1.0)
space.setBounds(bounds)
space.setup()


def inside(*numbers):
    state = space.allocState()
    state[0:2] = list(numbers)
    return space.satisfiesBounds(state)


answers = {str(numbers): inside(*numbers) for numbers in ((0.5, 0.5), (2.0, 0.0), (math.inf, 0.0), (math.nan, 0.0), (0.0, math.nan))}
for numbers, answer in answers.items():
    print(f"{numbers:12} within the bounds: {answer}")
assert list(answers.values()) == [True, False, False, True, True]

state = space.allocState()
state[0:2] = [math.nan, 2.0]
space.enforceBounds(state)
print("enforced:", list(state[0:2]))
assert math.isnan(state[0:2][0]) and state[0:2][1] == 1.0
PYTHON
"$PY" look.py
