# Sourced by the scripts that hold this version against an earlier one, after common.sh.

# Makes a folder $work with a worktree of $1 in it, which go when the script ends.
take_former() {
  here=$PWD
  work=$(mktemp -d)
  trap 'git -C "$here" worktree remove --force "$work/tree" 2>/dev/null || true; rm -rf "$work"' EXIT
  git worktree add --detach "$work/tree" "$1" >/dev/null 2>&1
}

# Builds targets of that worktree.
build_former() (
  cd "$work/tree"
  # Paths below it are no part of what ccache compares: the next run finds these objects.
  export CCACHE_BASEDIR=$work/tree
  {
    scripts/setup test  # what that version needs may be more
    configure release
    cmake --build build/release --target "$@"
  } >"$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
)

# Builds targets of this version.
build_present() {
  { configure release && cmake --build build/release --target "$@"; } >"$work/log" 2>&1 ||
    { tail -20 "$work/log"; exit 1; }
}
