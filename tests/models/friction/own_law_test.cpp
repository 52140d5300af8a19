#include "limcycle/models/friction/own_law.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "limcycle/models/catalogue.hpp"
#include "limcycle/models/element/element.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/own_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

/// F = 1 + v: a law with the required members only.
struct Bare {
  double output(const Input<double>& in, Mode, std::span<const double>) const { return 1.0 + in.v; }
  Scales scales() const { return {.velocity = 1.0, .output = 1.0}; }
};

/// A law that wrongly claims to be odd.
struct Crooked : Bare {
  static constexpr std::string_view kind = "crooked";
  bool odd() const { return true; }
};

/// A law whose force changes along the path.
struct Washboard : Bare {
  double output(const Input<double>& in, Mode, std::span<const double>) const { return in.v + std::sin(in.x); }
};

struct Sized : PlainLuGre {
  Scales said;
  Scales scales() const { return said; }
};

struct Ruled : Bare {
  double limit = 0.0;
  std::optional<BrokenRule> validate() const {
    if (limit > 0.0) return std::nullopt;
    return BrokenRule{"limit", "must be > 0"};
  }
};

struct Broken : Bare {
  bool odd() const { return true; }
  double output(const Input<double>&, Mode, std::span<const double>) const {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace

TEST_CASE("an own law says what its type says, and what is missing is filled in") {
  const NamedLuGre mine;
  const auto law = own_law(mine);
  const std::vector<double> z{3e-6, 99.0};  // the second number is not part of its state
  const Input<double> in{0.2, 5e-4, infinite};
  double dz[1];
  law.rate(in, {}, z, dz);
  CHECK(law.output(in, {}, z) == mine.output(in, {}, z));
  CHECK(dz[0] == mine.z_rate(in.v, z[0]));
  CHECK(law.kind() == "my-lugre");
  CHECK(law.odd());
  CHECK(law.state_scale(0) == 1.5 / 1e5);
  CHECK(law.has_storage());
  CHECK(law.storage({}, z) == 0.5 * 1e5 * 9e-12);
  CHECK_FALSE(law.follows_position());
  CHECK_FALSE(law.knows_sliding());

  const auto bare = own_law(Bare{});
  CHECK(bare.kind() == "own-law");
  CHECK(bare.states() == 0);
  CHECK(bare.guards({}) == 0);
  CHECK_FALSE(bare.odd());
  CHECK_FALSE(bare.has_storage());
  CHECK(bare.mirror({3}) == Mode{3});
}

TEST_CASE("an own law is a friction law, by its own name, which no case can name") {
  const Element element = own_law(NamedLuGre{});
  CHECK(element.is_friction());
  CHECK(element.kind() == "my-lugre");
  CHECK(find_kind(catalogue_of_elements().friction_laws, "own-law") == nullptr);
}

TEST_CASE("whether an own law follows its position is found out") {
  CHECK(own_law(Washboard{}).follows_position());
  CHECK_FALSE(own_law(Bare{}).follows_position());
  CHECK_FALSE(own_law(OwnJenkins{}).follows_position());
}

TEST_CASE("an own law that contradicts itself is refused, with its name and the reason") {
  CHECK_THROWS_WITH(own_law(Crooked{}), Contains("crooked") && Contains("odd()"));
  CHECK_THROWS_WITH(own_law(Ruled{}), Contains("limit must be > 0"));
  CHECK_NOTHROW(own_law(Ruled{{}, 1.0}));
  Sized sized;
  sized.said = {.displacement = infinite, .velocity = 1.0, .output = 1.0};
  CHECK_THROWS_WITH(own_law(sized), Contains("state_scale(0)"));
  sized.said = {.displacement = 1.0, .velocity = 0.0, .output = 1.0};
  CHECK_THROWS_WITH(own_law(sized), Contains("scales() must be positive"));
  sized.said = {.displacement = 1.0, .velocity = 1.0, .output = infinite};
  CHECK_THROWS_WITH(own_law(sized), Contains("scales().output"));
}

TEST_CASE("a law of NaN is no contradiction: what it is worth the methods say") { CHECK_NOTHROW(own_law(Broken{})); }

TEST_CASE("an own law stands in a loop where any friction law stands") {
  const Loop loop = servo(own_law(NamedLuGre{}));
  REQUIRE(loop.elements.size() == 1);
  CHECK(loop.ports[0].rubs);
  CHECK(loop.elements[0].kind() == "my-lugre");
}
