#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace crashrank::detail {

/// Bytes of the UTF-8 character that starts here, 0 if none does (overlong forms, surrogates and
/// code points beyond U+10FFFF included).
std::size_t utf8_length(std::string_view text);

/// One printable line of a text that is not trusted: control characters, and bytes that are not
/// UTF-8, as \xNN; cut after `limit` bytes.
std::string printable(std::string_view text, std::size_t limit = 400);

/// `printable` between single quotation marks.
std::string quoted(std::string_view text, std::size_t limit = 400);

/// The text with every byte that is not UTF-8 replaced by U+FFFD, cut between characters so that
/// it has at most `limit` bytes.
std::string to_utf8(std::string_view text, std::size_t limit);

}  // namespace crashrank::detail
