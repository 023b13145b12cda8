#!/usr/bin/env bash
# numba: loading one function from the cache on disk imports scipy.linalg and two hundred modules of the compiler.
#
# Expected: a function that was compiled before (cache=True) is loaded by reading its machine code; linear algebra, which it
# does not use, is imported by who calls it.
#
# Seen 2026-11-30 with numba 0.68.1, scipy 1.17.1, Python 3.11, Linux x86-64: the cache hits, and all of numba's implementations
# are imported before it is looked at (Cache.load_overload refreshes the target), with them scipy.linalg, to see whether there is one
# (numba/np/arraymath.py): 0.2 s of CPU, in each process. Without scipy the same machine code is loaded, and runs.
source "$(dirname "$(realpath "$0")")/prelude"
install numba==0.68.1 scipy==1.17.1
cat > look.py <<'PYTHON'
import sys
import time

import numba

before, began = set(sys.modules), time.process_time()


@numba.njit("int64(int64)", cache=True)
def successor(number):
    return number + 1


spent = time.process_time() - began
hits = sum(successor.stats.cache_hits.values())
print(f"{successor(1)}, from the cache: {hits}; modules imported: {len(set(sys.modules) - before)}, scipy.linalg: "
      f"{'scipy.linalg' in sys.modules}; {spent:.2f} s of CPU")
assert hits == int(sys.argv[1]) and ("scipy.linalg" in sys.modules) == (sys.argv[2] == "scipy")
PYTHON
"$PY" look.py 0 scipy
"$PY" look.py 1 scipy
"$PY" -m pip --disable-pip-version-check uninstall -q -y scipy
"$PY" look.py 1 none
