#pragma once

#include "crashrank/internal/base/export.hpp"

#include <cstddef>
#include <string>

namespace crashrank {

// Names come from files that are not trusted. Text for people passes through one of these first.
// None of them fails, whatever bytes the text holds; each costs O(length).

/// For a terminal: control characters, characters that turn the writing direction, and bytes that
/// are not UTF-8 become \xNN or \u{NNNN}, so that no name can move the cursor or pass for another.
CRASHRANK_API std::string escape_terminal(const std::string& text);

/// For XML, SVG and HTML, in text and in quoted attributes: & < > " ' become entities; characters
/// that XML 1.0 forbids and bytes that are not UTF-8 become U+FFFD; those that turn the writing
/// direction become \u{NNNN} as on a terminal, so that no name turns what stands beside it.
CRASHRANK_API std::string escape_xml(const std::string& text);

/// For a file's name: letters, digits, '.', '_' and '-' stay, anything else becomes '_'; no leading
/// dot, never empty, at most 80 characters. Different names may become the same one.
CRASHRANK_API std::string escape_file_name(const std::string& text);

/// Characters the text takes on a terminal: one a code point, which holds for the Latin, Greek and
/// Cyrillic scripts and is an estimate for the rest.
CRASHRANK_API std::size_t display_width(const std::string& text);

}  // namespace crashrank
