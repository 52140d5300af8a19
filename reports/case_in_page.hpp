#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// The case that a page holds for programs, so that the page alone makes its result again.
struct CaseInPage {
  std::string version;                 ///< of the program that wrote the page
  std::string command, flags;          ///< that made it: "report", "--quick"
  std::string file, sha256;            ///< as the case was named; of its bytes, as the page states it
  std::vector<std::string> overrides;  ///< "PATH=VALUE", in order
  std::string text;                    ///< bytes of the case file
};

/// A page that holds no case, or one that does not fit the rest of the page. what() is a rule for a message about the
/// page: "is not a limcycle page with an embedded case".
class PageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Script element of type application/json with id "case": every byte of a text in UTF-8 is kept, and nothing in it can
/// end the element. Schema "limcycle/1".
std::string case_element(const Provenance& provenance, const std::string& case_text, const std::string& command,
                         const std::string& flags);

/// Script element with id "result": a JSON document of the program, as it may stand in a page.
std::string result_element(const std::string& document);

/// What case_element() put into a page. Throws PageError if there is none, if it was written under a newer schema, or
/// if file, digest or overrides are not those of the result in the same page. That the digest is that of the text is
/// left to the caller, who can compute it.
CaseInPage case_in_page(std::string_view page);

/// Whether two results of `predict` (JSON documents) say the same but for rounding: the same outcomes and verdicts,
/// and the same cycles within their error. Documents that cannot be read are not the same.
bool same_result(const std::string& one, const std::string& other);

/// The document that result_element() put into a page; empty if there is none.
std::string result_in_page(std::string_view page);

}  // namespace limcycle
