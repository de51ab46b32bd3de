#pragma once

#include <array>
#include <string_view>

namespace crashrank::detail {

// Files of this folder that the build puts into the library.
std::string_view embedded_style();        ///< style.css
std::string_view embedded_data();         ///< data.js
std::string_view embedded_plan();         ///< plan.js
std::string_view embedded_view3d();       ///< view3d.js
std::string_view embedded_clock();        ///< clock.js
std::string_view embedded_scene();        ///< scene.js
std::string_view embedded_table();        ///< table.js
std::string_view embedded_uncertainty();  ///< uncertainty.js
std::string_view embedded_page();         ///< page.js
std::string_view embedded_reload();       ///< reload.js, of pages that `crashrank view` serves

/// The page's script, in the order in which its parts are read.
inline std::array<std::string_view, 8> embedded_scripts() {
  return {embedded_data(),  embedded_plan(),  embedded_view3d(),      embedded_clock(),
          embedded_scene(), embedded_table(), embedded_uncertainty(), embedded_page()};
}

}  // namespace crashrank::detail
