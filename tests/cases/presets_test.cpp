#include <catch2/catch.hpp>
#include <filesystem>

#include "limcycle/analysis/study/experiments/laws.hpp"
#include "limcycle/cases/case.hpp"

using namespace limcycle;

namespace {

const std::string folder = std::string(LIMCYCLE_SOURCE_DIR) + "/cases/presets/";

/// Same kind, same value of every parameter.
bool same(const Element<double>& a, const Element<double>& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&]<class Law>(const Law& one) {
        const Law& other = std::get<Law>(b);
        bool equal = true;
        for (const auto& parameter : Law::parameters())
          std::visit(
              [&](auto member) {
                const auto& x = one.*member;
                const auto& y = other.*member;
                if constexpr (requires { x == y; })
                  if (!(x == y)) {
                    UNSCOPED_INFO("differs in " << parameter.key);
                    equal = false;
                  }
              },
              parameter.member);
        return equal;
      },
      a);
}

}  // namespace

TEST_CASE("each preset is the setting that the experiments use") {
  std::size_t checked = 0;
  for (const auto& setting : law_settings()) {
    if (!is_friction_kind(setting.kind)) continue;
    INFO(setting.label);
    const Case preset = load_case(folder + setting.label + ".toml");
    REQUIRE(preset.element);
    CHECK(preset.df);
    CHECK(same(*preset.element, make_law(setting)));
    ++checked;
  }
  CHECK(checked >= 4);
}

TEST_CASE("there is no preset without a setting, and each law has one") {
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    INFO(file.path());
    const auto label = file.path().stem().string();
    CHECK(std::ranges::any_of(law_settings(), [&](const LawSetting& setting) { return setting.label == label; }));
  }
  FrictionLaws::for_each([]<template <class> class Kind>() {
    INFO(Kind<double>::kind);
    CHECK(std::ranges::any_of(law_settings(), [](const LawSetting& s) { return s.kind == Kind<double>::kind; }));
  });
}
