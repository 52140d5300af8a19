#include "limcycle/analysis/study/identify/identify.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/study/identify/fit.hpp"
#include "limcycle/analysis/study/identify/record/synthesize.hpp"
#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"
#include "limcycle/tests/analysis/study/identify/rigs.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

IdentifyReport identified(const Element& truth, const std::vector<std::string>& laws, const RigFaults& faults,
                          std::uint64_t seed) {
  IdentifyRequest request;
  for (const auto& kind : laws) request.laws.push_back(kind_named(kind));
  request.records = synthesize(truth, faults, seed);
  return identify(request);
}

struct Coverage {
  int inside = 0, all = 0, undetermined = 0;

  /// What 95 % of so many leave by chance: three standard deviations.
  double least() const { return 0.95 * all - 3.0 * std::sqrt(0.95 * 0.05 * all); }
};

/// How often the true numbers are in their intervals.
Coverage coverage(const Element& truth, int repetitions) {
  Coverage result;
  for (int i = 1; i <= repetitions; ++i) {
    const auto report = identified(truth, {std::string(truth.kind())}, {}, static_cast<std::uint64_t>(i));
    for (const auto& one : report.laws.front().numbers) {
      const double value = true_value(truth, one.name);
      ++result.all;
      result.undetermined += one.identifiable ? 0 : 1;
      result.inside += one.low && one.high && *one.low <= value && value <= *one.high ? 1 : 0;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("identify: without noise the numbers come out exactly") {
  for (const Element& truth : {coulomb_rig(), stribeck_rig(), dahl_rig(), lugre_rig()}) {
    INFO(truth.kind());
    const auto report = identified(truth, {std::string(truth.kind())}, {.noise = 0.0}, 1);
    REQUIRE(report.chosen);
    for (const auto& one : report.laws.front().numbers) {
      INFO(one.name);
      // The records are of finer steps than the fit; the break-away of a law that sticks is between two rows.
      const double tolerance = truth.may_stick() && one.name == "Fs" ? 5e-3 : 2e-3;
      CHECK(one.value == Approx(true_value(truth, one.name)).epsilon(tolerance));
      CHECK(one.identifiable);
    }
  }
}

TEST_CASE("identify: 95 % intervals hold the true numbers as often as they say") {
  for (const Element& truth : {coulomb_rig(), stribeck_rig(), dahl_rig()}) {
    INFO(truth.kind());
    const Coverage found = coverage(truth, samples(20));
    CHECK(found.undetermined == 0);
    CHECK(found.inside >= found.least());
  }
  const Coverage lugre = coverage(lugre_rig(), samples(4));
  CHECK(lugre.undetermined == 0);
  CHECK(lugre.inside >= lugre.least());
}

TEST_CASE("identify: where the law is linear in its numbers the interval is that of linear regression") {
  // Coulomb friction over positive steady velocities: F = Fc + sigma2 v, with Student's t for n - 2 degrees of freedom.
  FrictionRecord record{RecordKind::steady_velocity, "line", {}, {}, {}, {}, 0.0};
  RandomStream random(5, "line");
  double sv = 0.0, svv = 0.0, sF = 0.0, svF = 0.0;
  const double n = 30.0;
  for (int i = 1; i <= 30; ++i) {
    const double v = 0.01 * i, F = 2.0 + 3.0 * v + 0.05 * (random.uniform() - 0.5);
    record.v.push_back(v);
    record.F.push_back(F);
    sv += v;
    svv += v * v;
    sF += F;
    svF += v * F;
  }
  const double slope = (n * svF - sv * sF) / (n * svv - sv * sv), level = (sF - slope * sv) / n;
  double rss = 0.0;
  for (std::size_t i = 0; i < record.v.size(); ++i) rss += std::pow(record.F[i] - level - slope * record.v[i], 2);
  // Fs stands in no row; held, it is no number to be fitted.
  const IdentifyRequest request{{kind_named("coulomb")}, {record}, {{}, {{"Fs", 10.0}}, 4}};
  const IdentifyReport report = identify(request);
  const auto& law = report.laws.front();
  CHECK(law.fitted == 2);
  const double t = gsl_cdf_tdist_Pinv(0.975, n - 2.0), s2 = rss / (n - 2.0), D = n * svv - sv * sv;
  const auto& sigma2 = number_named(law, "sigma2");
  const auto& Fc = number_named(law, "Fc");
  CHECK(sigma2.value == Approx(slope).epsilon(1e-5));
  CHECK(Fc.value == Approx(level).epsilon(1e-5));
  CHECK(*sigma2.high - sigma2.value == Approx(t * std::sqrt(s2 * n / D)).epsilon(0.02));
  CHECK(*Fc.high - *Fc.low == Approx(2.0 * t * std::sqrt(s2 * svv / D)).epsilon(0.02));
  CHECK(law.bic == Approx(n * std::log(rss / n) + 2.0 * std::log(n)).epsilon(1e-6));
}

TEST_CASE("identify: with Fs = Fc the least squares are those on the bound") {
  // A level that rises with the speed is no Stribeck curve: the nearest one is constant, and that is the mean.
  FrictionRecord record{RecordKind::steady_velocity, "rising", {}, {}, {}, {}, 0.0};
  double mean = 0.0;
  for (int i = 1; i <= 40; ++i) {
    record.v.push_back(1e-4 * i);
    record.F.push_back(1.0 - 0.2 * std::exp(-std::pow(record.v.back() / 1e-3, 2)) + 0.002 * ((i * 7) % 5 - 2));
    mean += record.F.back() / 40.0;
  }
  for (const bool free_vs : {true, false}) {
    IdentifyRequest request{{kind_named("stribeck")}, {record}, {{}, {{"sigma2", 0.0}}, 4}};
    if (!free_vs) request.choice.fixed.emplace_back("vs", 1e-3);
    const auto report = identify(request);
    const auto& law = report.laws.front();
    REQUIRE(law.status == Status::converged);
    CHECK(number_named(law, "Fc").value == Approx(mean).epsilon(1e-6));
    CHECK(number_named(law, "Fs").value == number_named(law, "Fc").value);
    CHECK_FALSE(law.law.validate());
  }
  // Beside a fixed Fs it is the bound of Fc.
  const auto report = identify({{kind_named("stribeck")}, {record}, {{}, {{"sigma2", 0.0}, {"Fs", 0.9}}, 4}});
  CHECK(number_named(report.laws.front(), "Fc").value == Approx(0.9).epsilon(1e-12));
  CHECK_FALSE(report.laws.front().law.validate());
}

TEST_CASE("identify: a record that could be fitted exactly does not count for more than the others") {
  // Coulomb friction is linear in its numbers, and three rows on a line are fitted exactly. Both records count by their
  // relative noise, which is that of the long one.
  FrictionRecord line{RecordKind::steady_velocity, "line", {}, {}, {}, {}, 0.0};
  RandomStream random(3, "long");
  for (int i = 1; i <= 100; ++i) {
    line.v.push_back(0.01 * i);
    line.F.push_back(2.0 + 0.5 * line.v.back() + 0.1 * (random.uniform() - 0.5));
  }
  FrictionRecord three{RecordKind::steady_velocity, "three", {}, {}, {0.1, 0.2, 0.3}, {2.03, 2.08, 2.13}, 0.0};
  double A[2][2] = {}, b[2] = {};
  for (const auto* record : {&line, &three}) {
    const double weight = std::pow(*std::ranges::max_element(record->F), -2);
    for (std::size_t i = 0; i < record->v.size(); ++i) {
      const double row[2] = {1.0, record->v[i]};
      for (int j = 0; j < 2; ++j) {
        b[j] += weight * row[j] * record->F[i];
        for (int k = 0; k < 2; ++k) A[j][k] += weight * row[j] * row[k];
      }
    }
  }
  const double D = A[0][0] * A[1][1] - A[0][1] * A[1][0];
  const auto report = identify({{kind_named("coulomb")}, {line, three}, {{}, {{"Fs", 10.0}}, 4}});
  const auto& law = report.laws.front();
  CHECK(number_named(law, "Fc").value == Approx((b[0] * A[1][1] - A[0][1] * b[1]) / D).epsilon(1e-4));
  CHECK(number_named(law, "sigma2").value == Approx((A[0][0] * b[1] - A[1][0] * b[0]) / D).epsilon(1e-3));
}

TEST_CASE("identify: numbers that the records do not determine are named") {
  IdentifyRequest request;
  request.laws = {kind_named("lugre")};
  request.records = {synthesize(lugre_rig(), {}, 7).front()};  // steady velocities say nothing of the bristle
  const auto report = identify(request);
  const auto& law = report.laws.front();
  for (const char* name : {"Fs", "Fc", "vs", "sigma2"}) CHECK(number_named(law, name).identifiable);
  for (const char* name : {"sigma0", "sigma1"}) {
    CHECK_FALSE(number_named(law, name).identifiable);
    CHECK_FALSE(number_named(law, name).high);
  }
  CHECK(law.undetermined.size() == 2);

  request.laws = {kind_named("coulomb")};  // sliding says nothing of break-away
  request.records = {synthesize(coulomb_rig(), {}, 7).front()};
  CHECK_FALSE(number_named(identify(request).laws.front(), "Fs").identifiable);
}

TEST_CASE("identify: the simplest law that the records support is chosen") {
  const std::pair<Element, std::vector<std::string>> cases[] = {
      {coulomb_rig(), {"stribeck", "coulomb"}},
      {stribeck_rig(), {"coulomb", "lugre", "stribeck"}},
      {dahl_rig(), {"lugre", "stribeck", "dahl"}},
      {lugre_rig(), {"elasto-plastic", "dahl", "lugre"}},
  };
  for (const auto& [truth, laws] : some_of(std::vector(std::begin(cases), std::end(cases)))) {
    INFO(truth.kind());
    const auto report = identified(truth, laws, {}, 11);
    REQUIRE(report.chosen);
    CHECK(report.laws[*report.chosen].law.kind() == truth.kind());
  }
}

TEST_CASE("identify: the elements of gms come out in the order in which they yield") {
  const Element truth = gms_rig();
  const auto report = identified(truth, {"gms"}, {}, 4);
  const auto& law = report.laws.front();
  REQUIRE(law.status == Status::converged);
  int inside = 0;
  double sum = 0.0;
  for (const auto& one : law.numbers) {
    const double value = true_value(truth, one.name);
    INFO(one.name);
    CHECK(one.identifiable);
    CHECK(one.value == Approx(value).epsilon(0.15));
    inside += *one.low <= value && value <= *one.high ? 1 : 0;
    if (one.name.starts_with("alpha")) sum += one.value;
  }
  CHECK(sum == Approx(1.0).epsilon(1e-12));
  CHECK(inside >= 11);  // of 13
}

TEST_CASE("identify: the same numbers in other units, and for the mirrored motion") {
  const Element truth = lugre_rig();
  IdentifyRequest request;
  request.laws = {kind_named("lugre")};
  request.records = synthesize(truth, {}, 2);
  const auto own = identify(request);
  for (auto& record : request.records) {
    for (double& one : record.x) one *= -1e3;
    for (double& one : record.v) one *= -1e3;
    for (double& one : record.F) one *= -1e-3;
  }
  const auto other = identify(request);
  const std::pair<const char*, double> units[] = {{"Fs", 1e-3},     {"Fc", 1e-3},     {"vs", 1e3},
                                                  {"sigma0", 1e-6}, {"sigma1", 1e-6}, {"sigma2", 1e-6}};
  for (const auto& [name, unit] : units) {
    const auto &a = number_named(own.laws.front(), name), &b = number_named(other.laws.front(), name);
    CHECK(b.value == Approx(unit * a.value).epsilon(2e-3));
    CHECK(*b.high - *b.low == Approx(unit * (*a.high - *a.low)).epsilon(0.05));
  }
}

TEST_CASE("identify: levels on their bound keep a valid law") {
  const Element truth = law_with("stribeck", {{"Fs", 1.0}, {"Fc", 1.0}, {"vs", 1e-3}, {"sigma2", 0.0}});
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto report = identified(truth, {"stribeck"}, {}, seed);
    const auto& law = report.laws.front();
    CHECK(law.status == Status::converged);
    CHECK_FALSE(law.law.validate());
    CHECK(law.law.number("sigma2").value() >= 0.0);
    CHECK(law.law.number("Fs").value() == Approx(1.0).epsilon(0.01));
  }
}

TEST_CASE("identify: sigma2 = 0 without noise is found, on its bound or next to it") {
  const Element truth = lugre_rig().with("sigma2", 0.0);
  const auto report = identified(truth, {"lugre"}, {.noise = 0.0}, 1);
  REQUIRE(report.chosen);
  const auto& law = report.laws.front();
  CHECK_FALSE(law.law.validate());
  CHECK(number_named(law, "sigma2").value < 1e-4);  // of what the march leaves
  CHECK(number_named(law, "Fc").value == Approx(1.0).epsilon(1e-3));
}

TEST_CASE("identify: positions of an encoder give the law, and no break-away that was not measured") {
  const auto report = identified(lugre_rig(), {"stribeck", "lugre"}, {.noise = 0.005, .quantum = 1e-8}, 2);
  for (const auto& record : report.records) CHECK(record.break_aways.empty());
  REQUIRE(report.chosen);
  const auto& law = report.laws[*report.chosen];
  REQUIRE(law.law.kind() == "lugre");
  for (const char* name : {"Fs", "Fc", "vs", "sigma0"})
    CHECK(number_named(law, name).value == Approx(true_value(lugre_rig(), name)).epsilon(0.05));
}

TEST_CASE("identify: a stop chooses no law and keeps what there is") {
  IdentifyRequest request{{kind_named("coulomb"), kind_named("stribeck")}, synthesize(stribeck_rig(), {}, 2), {}};
  for (const int most : {0, 5, 40}) {
    INFO(most);
    int asked = 0;
    IdentifyOptions options;
    options.stop = [&] { return ++asked > most; };
    const auto report = identify(request, options);
    CHECK(report.status == Status::interrupted);
    CHECK_FALSE(report.chosen);
    for (const auto& law : report.laws) CHECK(law.status == Status::interrupted);
    CHECK(report.laws.empty() == (most == 0));
  }
}

TEST_CASE("misfit: slopes are those of the entries, with levels of their own for each direction") {
  std::vector<FrictionRecord> raw = synthesize(coulomb_rig(), {}, 6);
  FrictionRecord back = raw.back();
  for (auto* column : {&back.x, &back.v, &back.F})
    for (double& one : *column) one = -one;
  raw.push_back(back);
  std::vector<PreparedRecord> records;
  for (const auto& record : raw) records.push_back(prepare(record, true));
  REQUIRE_FALSE(records.back().break_aways.empty());
  const FreeChoice choices[] = {{}, {{}, {{"Fs_minus", 1.7}}, 4}, {{"Fs_minus", "Fc_minus"}, {}, 4}};
  for (const auto& choice : choices) {
    const ParameterSpace space(kind_named("coulomb"), records, choice);
    const Misfit misfit(space, records, std::vector<double>(records.size(), 0.01));
    const Eigen::VectorXd u = space.start(std::vector<double>(space.numbers().size(), 0.6));
    Eigen::VectorXd entries, low, high;
    Eigen::MatrixXd slopes;
    REQUIRE(misfit.at(u, entries, &slopes));
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      Eigen::VectorXd below = u, above = u;
      below(k) -= 1e-6;
      above(k) += 1e-6;
      REQUIRE(misfit.at(below, low, nullptr));
      REQUIRE(misfit.at(above, high, nullptr));
      const double error = ((high - low) / 2e-6 - slopes.col(k)).cwiseAbs().maxCoeff();
      CHECK(error < 1e-5 * slopes.col(k).cwiseAbs().maxCoeff());
    }
  }
}

TEST_CASE("identify: a law that misses something leaves coloured residuals, the true one white ones") {
  const auto report = identified(stribeck_rig(), {"coulomb", "stribeck"}, {}, 5);
  double least = 1.0, least_of_true = 1.0;
  for (const auto& fit : report.laws[0].records) least = std::min(least, fit.whiteness.probability);
  for (const auto& fit : report.laws[1].records) least_of_true = std::min(least_of_true, fit.whiteness.probability);
  CHECK(least < 1e-6);
  CHECK(least_of_true > 1e-3);
}

TEST_CASE("whiteness: white noise passes as often as it should, and a moving average does not") {
  int rejected = 0;
  for (std::uint64_t run = 0; run < 400; ++run) {
    RandomStream random(run, "white");
    std::vector<double> noise(200);
    for (double& one : noise) one = random.uniform() - 0.5;
    rejected += whiteness(noise).probability < 0.05 ? 1 : 0;
    if (run > 3) continue;
    for (std::size_t i = 1; i < noise.size(); ++i) noise[i - 1] += noise[i];
    CHECK(whiteness(noise).probability < 1e-6);
    CHECK(whiteness(noise).autocorrelation == Approx(0.5).margin(0.15));
  }
  CHECK(rejected > 6);
  CHECK(rejected < 40);  // 20 expected
}

TEST_CASE("whiteness: an offset is not white, and few rows are not tested") {
  RandomStream random(1, "offset");
  std::vector<double> noise(200);
  for (double& one : noise) one = random.uniform();
  CHECK(whiteness(noise).probability < 1e-6);
  noise.resize(19);
  CHECK(std::isnan(whiteness(noise).probability));
}

TEST_CASE("synthesize: a seed gives the same records, and noise of the size that was asked for") {
  const Element truth = stribeck_rig();
  const auto one = synthesize(truth, {}, 9), again = synthesize(truth, {}, 9),
             clean = synthesize(truth, {.noise = 0.0}, 9);
  REQUIRE(one.size() == 4);
  for (std::size_t r = 0; r < one.size(); ++r) {
    CHECK(one[r].F == again[r].F);
    double power = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < one[r].F.size(); ++i) {
      power += std::pow(one[r].F[i] - clean[r].F[i], 2);
      largest = std::max(largest, std::abs(clean[r].F[i]));
    }
    CHECK(std::sqrt(power / static_cast<double>(one[r].F.size())) == Approx(0.01 * largest).epsilon(0.25));
  }
  CHECK(synthesize(truth, {.quantum = 1e-7}, 9)[1].v.empty());
  CHECK(synthesize(truth, {}, 9, [] { return true; }).empty());
}

TEST_CASE("synthesize: jitter moves the rows along the motion, force and velocity included") {
  const auto clean = synthesize(stribeck_rig(), {.noise = 0.0}, 4)[1];
  const auto record = synthesize(stribeck_rig(), {.noise = 0.0, .jitter = 0.1}, 4)[1];
  double moved = 0.0;
  for (std::size_t i = 0; i < record.v.size(); ++i) {
    const double v = record.v[i], g = 1.0 + 0.5 * std::exp(-std::pow(v / 1e-3, 2));
    CHECK(record.F[i] == Approx(g + 20.0 * v).epsilon(1e-3));
    moved = std::max(moved, std::abs(record.v[i] - clean.v[i]));
  }
  CHECK(moved > 1e-6);
  CHECK_NOTHROW(prepare(record, false));
}
