#include "mesh/importer/limits.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>

// Sanitizers reserve terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CRASHRANK_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define CRASHRANK_SANITIZED 1
#endif
#endif

#ifdef CRASHRANK_SANITIZED
// A finding in the parser has to look to the caller like the crash that it is: a signal. Visible,
// since the sanitizer may be a shared library.
#define CRASHRANK_VISIBLE __attribute__((visibility("default")))
extern "C" CRASHRANK_VISIBLE const char* __asan_default_options() {
  return "abort_on_error=1:detect_leaks=0";
}
extern "C" CRASHRANK_VISIBLE const char* __ubsan_default_options() { return "abort_on_error=1"; }
extern "C" CRASHRANK_VISIBLE const char* __tsan_default_options() { return "abort_on_error=1"; }
#endif

namespace crashrank::importer {
namespace {

bool limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  rlimit now{};
  if (::getrlimit(resource, &now) != 0) return false;
  // A limit that is tighter already stays.
  const rlimit wanted{std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
  return ::setrlimit(resource, &wanted) == 0;
}

}  // namespace

bool confine(std::size_t memory_bytes, double seconds) {
  // Whatever other threads of the caller had open without O_CLOEXEC; older kernels lack the call.
#ifdef SYS_close_range
  ::syscall(SYS_close_range, 3U, ~0U, 0U);
#endif
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  const auto whole_seconds = static_cast<rlim_t>(std::max(1.0, std::round(seconds)));
  bool done = limit(RLIMIT_CPU, whole_seconds, whole_seconds + 1);
#ifndef CRASHRANK_SANITIZED
  done = limit(RLIMIT_AS, memory_bytes, memory_bytes) && done;
#else
  static_cast<void>(memory_bytes);
#endif
  done = limit(RLIMIT_CORE, 0, 0) && done;
  done = limit(RLIMIT_FSIZE, 0, 0) && done;
  return limit(RLIMIT_NOFILE, 32, 32) && done;
}

}  // namespace crashrank::importer
