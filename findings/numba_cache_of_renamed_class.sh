#!/usr/bin/env bash
# numba: a cached function cannot be loaded, nor compiled, after the class of its argument was renamed.
#
# Expected: the source changed, so that what the cache has of it is stale (its index holds the source's time and size for that),
# and the function is compiled again, as after any other change.
#
# Seen 2026-11-30 with numba 0.68.1, Python 3.11, Linux x86-64: the index is unpickled whole before its stamp is compared, and holds
# the types of arguments. A NamedTuple that is called otherwise now ends the program with an AttributeError, on every start, until
# somebody deletes the cache: so it goes whoever upgrades a package whose kernels take one. A change elsewhere in the file does no harm.
source "$(dirname "$(realpath "$0")")/prelude"
install numba==0.68.1
cat > write.py <<'PYTHON'
import sys

name, added = sys.argv[1:]
open("kernel.py", "w").write(f"""
from typing import NamedTuple

import numba


class {name}(NamedTuple):
    size: int


@numba.njit(cache=True)
def larger(some):
    return some.size + {added}


print(larger({name}(1)))
""")
PYTHON
"$PY" write.py Box 1 && "$PY" kernel.py
echo "changed, the class's name kept:"
"$PY" write.py Box 22 && "$PY" -c "import kernel"
echo "the class renamed:"
"$PY" write.py Parcel 333
if "$PY" -c "import kernel" 2> error.txt; then exit 1; fi
tail -1 error.txt
grep -q "AttributeError: Can't get attribute 'Box'" error.txt
