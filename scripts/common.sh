# Shared by the scripts beside it: sourced, not run. Leaves the shell in the repository root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# As many compilers as there are processors, and as the free memory carries: 1.5 GB each.
parallel_jobs() {
  local processors memory
  processors=$(nproc)
  memory=$(awk '/MemAvailable/ {print int($2 / 1500000)}' /proc/meminfo)
  [ "${memory:-1}" -ge 1 ] || memory=1
  echo $((processors < memory ? processors : memory))
}

step() { printf '\n== %s\n' "$*"; }

# Every compiler warns about other things: warnings are errors with the one they were mended for.
home_compiler() { [ "$(g++ -dumpversion)" = 12 ]; }

# python_environment FOLDER REQUIREMENTS...: a virtual environment with these packages, made anew where
# they or the interpreter changed.
python_environment() {
  local folder=$1 stamp
  shift
  stamp=$({ "${PYTHON:-python3}" --version; cat "$@"; } | sha256sum | cut -c1-16)
  if [ ! -e "$folder/$stamp" ]; then
    rm -rf "$folder"
    "${PYTHON:-python3}" -m venv "$folder"
    "$folder/bin/python" -m pip install -q --disable-pip-version-check "${@/#/-r}"
    touch "$folder/$stamp"
  fi
}

# configure PRESET [OPTION...]: through ccache where the machine has it; without, sources that are compiled
# together take a third less.
configure() {
  local preset=$1 options=("${@:2}")
  if command -v ccache >/dev/null && [ -z "${CCACHE_DISABLE:-}" ]; then
    options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  else
    options+=(-DCMAKE_UNITY_BUILD=ON)
  fi
  home_compiler || options+=(-DCRASHRANK_WERROR=OFF)
  cmake --preset "$preset" ${options[@]+"${options[@]}"}
}
