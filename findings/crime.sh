# Sourced by crime-*.sh: `crime` runs a Python text with CriMe in a temporary environment.
set -euo pipefail
findings=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --requirement "$findings/../python/requirements-comparison.txt"

crime() {
  PYTHONPATH=$findings PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg "$folder/env/bin/python" -W ignore -
}
