#pragma once
#include <string>

#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/table.hpp"

namespace limcycle {

/// A self-contained page without scripts: title, the answer, a body, and how to make it again. `command`: what to type
/// after "limcycle"; `case_text`: the case file as read; empty: left out.
std::string static_page(const Provenance& provenance, const std::string& answer, const std::string& body,
                        const std::string& command, const std::string& case_text);

/// A table with its caption.
std::string static_table(const Table& table, const std::string& caption);

}  // namespace limcycle
