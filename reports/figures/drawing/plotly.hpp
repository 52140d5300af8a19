#pragma once
#include <string_view>

namespace limcycle {

/// The text of Plotly's cartesian bundle (MIT licence, version pinned in package.json), UTF-8, ready to stand between
/// `<script>` and `</script>` of a page that declares UTF-8. It is part of the program: no file is read.
[[nodiscard]] std::string_view plotly_script();

}  // namespace limcycle
