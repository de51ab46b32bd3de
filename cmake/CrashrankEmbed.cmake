# crashrank_embed(TARGET NAME FILE): puts a file's bytes into the library, to be read as
# crashrank::detail::embedded_NAME() (report/page/embedded.hpp).
function(crashrank_embed target name file)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_${name}.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
#include "report/page/embedded.hpp"

__asm__(".pushsection .rodata\n"
        "crashrank_@name@_begin:\n"
        ".incbin \"@file@\"\n"
        "crashrank_@name@_end:\n"
        ".popsection\n");

extern "C" {
extern const char embedded_@name@_begin[] __asm__("crashrank_@name@_begin");
extern const char embedded_@name@_end[] __asm__("crashrank_@name@_end");
}

namespace crashrank::detail {
std::string_view embedded_@name@() {
  return {embedded_@name@_begin,
          static_cast<std::size_t>(embedded_@name@_end - embedded_@name@_begin)};
}
}  // namespace crashrank::detail
]])
  set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES
    OBJECT_DEPENDS ${file} SKIP_UNITY_BUILD_INCLUSION ON)  # a unity source drops the dependency
  target_sources(${target} PRIVATE ${source})
endfunction()
