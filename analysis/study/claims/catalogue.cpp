#include <iterator>

#include "limcycle/analysis/study/claims/claim.hpp"

namespace limcycle {

const std::vector<Claim>& claims() {
  static const std::vector<Claim> all = [] {
    std::vector<Claim> list;
    for (const auto subject : {describing_function_claims, limit_cycle_claims, error_bound_claims, friction_claims,
                               stability_claims, source_document_claims}) {
      auto some = subject();
      list.insert(list.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
    }
    return list;
  }();
  return all;
}

}  // namespace limcycle
