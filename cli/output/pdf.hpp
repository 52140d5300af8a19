#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace limcycle {

/// True if the program rsvg-convert (of librsvg) is on the path.
bool makes_pdf();

/// A picture as PDF, by rsvg-convert, without a time stamp: the same picture gives the same bytes. Nothing if that
/// fails; its message is then on stderr.
std::optional<std::string> pdf_of(std::string_view svg);

}  // namespace limcycle
