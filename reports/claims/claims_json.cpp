#include <cmath>

#include "limcycle/reports/claims/claims.hpp"
#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

Json claim_object(const Claim& claim) {
  return {{"id", claim.id},         {"statement", claim.statement},          {"formula", claim.formula},
          {"source", claim.source}, {"evidence", to_string(claim.evidence)}, {"range", claim.range},
          {"test", claim.test},     {"expected", to_string(claim.expected)}};
}

Json check_object(const ClaimCheck& check) {
  return {{"where", check.where},
          {"quantity", check.quantity},
          {"unit", check.unit},
          {"claimed", number(check.claimed)},
          {"computed", number(check.computed)},
          {"error", number(check.error)},
          {"allowed", number(check.allowed)},
          {"random", check.random},
          {"holds", check.holds}};
}

Json tested_object(const TestedClaim& one) {
  Json object = claim_object(one.claim), checks = Json::array();
  for (const auto& check : one.result.checks) checks.push_back(check_object(check));
  object["verdict"] = to_string(one.result.verdict);
  object["as_expected"] = one.as_expected();
  object["checks"] = std::move(checks);
  object["finding"] = one.result.finding;
  object["counterexample"] = one.result.counterexample.empty() ? Json(nullptr) : Json(one.result.counterexample);
  object["status"] = to_string(one.result.status);
  return object;
}

template <class List>
std::string document(const Provenance& provenance, const List& list, Json (*object)(const typename List::value_type&),
                     Status ended) {
  Json top;
  top["claims"] = Json::array();
  for (const auto& one : list) top["claims"].push_back(object(one));
  top["status"] = to_string(ended);
  return json_document("claims", provenance, json_text(top));
}

}  // namespace

std::string claims_list_json(const Provenance& provenance, const std::vector<Claim>& claims) {
  return document(provenance, claims, claim_object, Status::converged);
}

std::string claims_json(const Provenance& provenance, const std::vector<TestedClaim>& tested, Status ended) {
  return document(provenance, tested, tested_object, ended);
}

std::string claims_csv(const std::vector<TestedClaim>& tested) {
  std::string out = csv_line({"id", "verdict", "expected", "where", "quantity", "unit", "claimed", "computed", "error",
                              "allowed", "random", "holds"});
  for (const auto& one : tested) {
    const std::string verdict(to_string(one.result.verdict)), expected(to_string(one.claim.expected));
    for (const auto& check : one.result.checks)
      out += csv_line({one.claim.id, verdict, expected, check.where, check.quantity, check.unit,
                       shortest(check.claimed), shortest(check.computed), shortest(check.error),
                       shortest(check.allowed), check.random ? "true" : "false", check.holds ? "true" : "false"});
    if (one.result.checks.empty())
      out += csv_line({one.claim.id, verdict, expected, "", "", "", "", "", "", "", "", ""});
  }
  return out;
}

}  // namespace limcycle
