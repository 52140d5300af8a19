#include <string>

#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/page/parts.hpp"

namespace limcycle {

std::string_view page_script() {
  static const std::string joined = [] {
    std::string all = "\"use strict\";\n(() => {\n";  // script elements of a page share their names
    for (const auto part :
         {script_base(), script_figures(), script_nyquist(), script_tables(), script_saving(), script_page()})
      all += part;
    return all + "})();\n";
  }();
  return joined;
}

}  // namespace limcycle
