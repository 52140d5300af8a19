#pragma once
#include <string>

namespace limcycle {

/// Markup in which the style element of each inline picture (svg without a class) touches that picture only: a style in
/// a page holds for all of it otherwise. The k-th such picture gets the class "picture-k" and its rules that prefix.
std::string with_scoped_styles(const std::string& markup);

}  // namespace limcycle
