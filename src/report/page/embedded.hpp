#pragma once

#include <string_view>

namespace crashrank::detail {

// Files that the build puts into the library; empty where the build had none.
std::string_view embedded_style();  ///< page/style.css
std::string_view embedded_view();   ///< page/view.js
std::string_view embedded_three();  ///< three.js, minified

}  // namespace crashrank::detail
