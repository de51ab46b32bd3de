#!/usr/bin/env bash
# same_answers.sh SOURCE_DIR WORK_DIR EIGEN_DIR: builds the collision core with each compiler that is
# here and each set of flags, answers the same queries with each, and compares with the hashes beside
# this script. -march=x86-64-v3 lets compilers fuse multiply and add unless they are told not to.
set -euo pipefail
source=$1
work=$2
eigen=$3
here=$source/tests/collide/builds
mkdir -p "$work"

launcher=()
! command -v ccache >/dev/null || launcher=(ccache)

# build NAME COMPILER FLAGS...
build() {
  local name=$1
  shift
  local objects=() file
  for file in "$here/fixed_queries.cpp" "$source"/src/base/sha256.cpp \
    "$source"/src/collide/pair_hash.cpp "$source"/src/collide/wide_collide.cpp; do
    local object
    object=$work/$name-$(basename "$file" .cpp).o
    "${launcher[@]}" "$@" -std=c++20 -ffp-contract=off -DNDEBUG -I"$source/include" \
      -I"$source/src" -isystem "$eigen" -c "$file" -o "$object"
    objects+=("$object")
  done
  "$1" "${objects[@]}" -lhwy -o "$work/$name"
}

builds=("g++ -O0" "g++ -O3" "g++ -O3 -march=x86-64-v3")
clang=$(command -v clang++-14 || command -v clang++ || true)
if [ -n "$clang" ]; then
  builds+=("$clang -O3" "$clang -O3 -march=x86-64-v3")
else
  echo "clang++ is not here: its builds are left out"
fi

expected=$(cat "$here/answers.txt")
wrong=0
for one in "${builds[@]}"; do
  read -r -a command <<<"$one"
  name=$(basename "$one" | tr -c 'a-z0-9\n+' '_')
  build "$name" "${command[@]}"
  if [[ $one = *v3* ]] && ! grep -qw avx2 /proc/cpuinfo; then
    echo "built, not run, this processor has no AVX2: $one"
    continue
  fi
  printf '%s: ' "$one"
  answers=$("$work/$name" 2>&1 >"$work/$name.txt") || { echo "$answers"; wrong=1; continue; }
  if [ "$(cat "$work/$name.txt")" = "$expected" ]; then
    echo "same answers, $answers"
  else
    echo "OTHER ANSWERS: $(cat "$work/$name.txt")"
    wrong=1
  fi
done
exit $wrong
