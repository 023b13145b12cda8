"""`gnn-bb` called as the paper calls it: from where the body is, with the orientation that comes out.

Run it: tamp-bench run --samplers on=benchmarks/as_published/gnn_bb.py:alone --seeds 100
"""

from grounding.registry import shipped_model
from grounding.runtime import Grounding

grounding = Grounding(shipped_model("on", "gnn-bb"))
