#include "crashrank/base/version.hpp"
#include "crashrank/crashrank.h"

int32_t crashrank_abi_version() { return CRASHRANK_ABI_VERSION; }

const char* crashrank_version() { return crashrank::library_version(); }
