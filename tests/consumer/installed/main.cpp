#include "query.hpp"

#ifdef WITH_LIBRARY
#include <crashrank/base/version.hpp>
#endif

#include <cstdio>
#include <cstring>

namespace {

bool runs_here() {
#ifdef NEEDS_V3
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return true;
#endif
}

}  // namespace

int main() {
  if (!runs_here()) {
    std::puts("not run: this processor lacks what the flags ask for");
    return 0;
  }
#ifdef WITH_LIBRARY
  if (std::strcmp(crashrank::library_version(), CRASHRANK_VERSION_STRING) != 0) return 2;
#endif
  const std::string answer = ask_everything();
#ifdef MIXED
  if (layout() != layout_v3()) {
    std::puts("public types look different under other flags");
    return 1;
  }
  if (answer != ask_everything_v3()) {
    std::printf("%sunder other flags\n%s", answer.c_str(), ask_everything_v3().c_str());
    return 1;
  }
#endif
  std::fputs(answer.c_str(), stdout);
  return 0;
}
