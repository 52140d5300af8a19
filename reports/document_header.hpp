#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// The name of a status, but "time-limit" for `interrupted` if the time limit interrupted the command.
std::string_view status_word(const Provenance& provenance, Status status);

/// JSON document of schema "limcycle/1": schema, command, case and provenance, then the members of `body`, itself the
/// text of a JSON object, whose "status" is replaced as by status_word(). Without a case its title, file and sha256 are
/// null. Text that is not UTF-8 is replaced.
std::string json_document(const std::string& command, const Provenance& provenance, const std::string& body);

/// The beginning of such a document, for one that is too long to be parsed: members follow as ",\n  "key": value", then
/// "\n}\n".
std::string json_beginning(const std::string& command, const Provenance& provenance);

/// One line of CSV (RFC 4180, ended by a newline only).
std::string csv_line(const std::vector<std::string>& fields);

}  // namespace limcycle
