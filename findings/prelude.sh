# Sourced by the scripts: `install PACKAGE==VERSION ...` makes $PY, a Python with these in a folder that is removed at the end.
set -euo pipefail
FOLDER=$(mktemp -d)
trap 'rm -rf "$FOLDER"' EXIT
install() {
  python3 -m venv "$FOLDER/venv"
  "$FOLDER/venv/bin/python" -m pip --disable-pip-version-check install -q --only-binary :all: "$@"
  PY="$FOLDER/venv/bin/python"
  cd "$FOLDER"
}
