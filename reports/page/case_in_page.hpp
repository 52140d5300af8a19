#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// The case in a page, stored for programs, so that the result can be reproduced from the page alone.
struct CaseInPage {
  std::string version;                 ///< of the program that wrote the page
  std::string command, flags;          ///< of the page: "report", "--quick"
  std::string file, sha256;            ///< name of the case; digest of its bytes, as stated in the page
  std::vector<std::string> overrides;  ///< "PATH=VALUE", in order
  std::string text;                    ///< bytes of the case file
};

/// A page without a case, or with one that does not fit the rest of the page. what() is a rule for a message about the
/// page: "is not a limcycle page with an embedded case".
class PageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Script element of type application/json with id "case": it keeps every byte of a text in UTF-8, and nothing in the
/// text can end the element. Schema "limcycle/1".
std::string case_element(const Provenance& provenance, const std::string& case_text, const std::string& command,
                         const std::string& flags);

/// Script element with id "result": a JSON document of the program, made safe for a page.
std::string result_element(const std::string& document);

/// Reads the result of case_element() from a page. Throws PageError if there is none, if it was written under a newer
/// schema, or if file, digest or overrides are not those of the result in the same page. The caller must check the
/// digest against the text.
CaseInPage case_in_page(std::string_view page);

/// True if two results of `predict` (JSON documents) agree to rounding: the same outcomes and verdicts, and the same
/// cycles within their error. False for documents that cannot be read.
bool same_result(const std::string& one, const std::string& other);

/// The document written by result_element() into a page; empty if there is none.
std::string result_in_page(std::string_view page);

}  // namespace limcycle
