#include <catch2/catch.hpp>
#include <filesystem>

#include "limcycle/analysis/study/experiments/runs/laws.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/models/laws.hpp"

using namespace limcycle;

namespace {

const std::string folder = std::string(LIMCYCLE_SOURCE_DIR) + "/cases/presets/";

/// True if kind and values of all parameters are the same.
bool same(const Element& a, const Element& b) {
  if (!a.is_of_kind_of(b)) return false;
  for (std::size_t i = 0; i < a.parameters().size(); ++i)
    if (a.values()[i] != b.values()[i]) {
      UNSCOPED_INFO("differs in " << a.parameters()[i].key);
      return false;
    }
  return true;
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
