#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "limcycle/reports/store/store.hpp"
#include "limcycle/tests/cli/started.hpp"
#include "limcycle/tests/setting.hpp"
#include "limcycle/tests/share.hpp"

// The program under mpirun. If there is none, or the program was built without MPI, it must refuse to be started as
// several processes, which is then tested.

using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

using Words = std::vector<std::string>;

const std::string hunting_servo = LIMCYCLE_SOURCE_DIR "/cases/pid-lugre.toml";

bool mpirun_is_here() {
  static const bool here =
      run({"--version"}).out.find("MPI") != std::string::npos && std::system("command -v mpirun > /dev/null") == 0;
  return here;
}

Words operator+(Words all, const Words& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Words map_of(const std::string& kd, const std::string& Fs) {
  return {"map", hunting_servo, "--x", "loop.controller.kd=6:120:" + kd, "--y", "loop.friction.Fs=1.05:1.5:" + Fs};
}

/// mpirun with so many ranks, in the background.
class RankedJob : public Started {
 public:
  RankedJob(const Scratch& scratch, int ranks, const Words& arguments, const Words& before = {})
      : Started(scratch, Words{"env", "ASAN_OPTIONS=detect_leaks=0",  // Open MPI frees little at the end
                               "mpirun", "--allow-run-as-root", "--oversubscribe", "-n", std::to_string(ranks)} +
                             before + Words{tested_program} + arguments) {}

  /// Process ids of the ranks.
  std::vector<pid_t> ranks() const {
    std::vector<pid_t> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      std::ifstream in(entry.path() / "stat");
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      const auto end = text.rfind(')');  // the name may contain anything; then: state, parent
      if (end != std::string::npos && end + 4 < text.size() && std::atoi(text.c_str() + end + 4) == pid())
        found.push_back(std::atoi(name.c_str()));
    }
    std::ranges::sort(found);
    return found;
  }
};

Ran run_ranks(int ranks, const Words& arguments, const Words& before = {}) {
  const Scratch scratch;
  return RankedJob(scratch, ranks, arguments, before).wait();
}

int times_in(const std::string& text, const std::string& words) {
  int count = 0;
  for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

std::size_t stored(const std::string& path) {
  try {
    return limcycle::read_store(path).activity.known;
  } catch (const limcycle::StoreError&) {
    return 0;  // not yet
  }
}

/// Checks that several processes write the same documents as one.
void same_documents(const Words& command, std::initializer_list<int> numbers_of_ranks) {
  const Scratch scratch;
  const Ran alone = run(command + Words{"--json", scratch.file("1.json"), "--csv", scratch.file("1.csv")});
  REQUIRE(alone.code == 0);
  for (const int ranks : numbers_of_ranks) {
    INFO(ranks << " ranks");
    const Ran shared = run_ranks(ranks, command + Words{"--json", scratch.file("n.json"), "--csv",
                                                        scratch.file("n.csv"), "--store", scratch.file("store")});
    INFO(shared.err);
    CHECK(shared.code == 0);
    CHECK(shared.out == alone.out);
    CHECK(shared.err.empty());
    CHECK(scratch.get("n.json") == scratch.get("1.json"));
    CHECK(scratch.get("n.csv") == scratch.get("1.csv"));
    CHECK(stored(scratch.file("store")) > 0);
    std::filesystem::remove(scratch.file("store"));
  }
}

}  // namespace

TEST_CASE("ranks: processes that cannot find each other are refused, and one of them says so") {
  const auto started_as = [](const std::string& process) {
    // A Slurm step whose processes do not know of each other.
    const Scratch scratch;
    const int status = std::system(("SLURM_STEP_NUM_TASKS=2 SLURM_PROCID=" + process + " ASAN_OPTIONS=detect_leaks=0 " +
                                    quoted(tested_program) + " laws > " + quoted(scratch.file("out")) + " 2> " +
                                    quoted(scratch.file("err")))
                                       .c_str());
    return Ran{WEXITSTATUS(status), scratch.get("out"), scratch.get("err")};
  };
  const Ran first = started_as("0"), second = started_as("1");
  CHECK(first.code == 2);
  CHECK_THAT(first.err, Contains("started as 2 processes, but"));
  CHECK(times_in(first.err, "limcycle: ") == 1);
  CHECK(second.code == 2);
  CHECK(second.err.empty());
  CHECK((first.out + second.out).empty());
}

TEST_CASE("ranks: a map has the same bytes for any number of them") {
  if (mpirun_is_here()) same_documents(map_of("3", "3"), {1, 2, 4});
}

TEST_CASE("ranks: a sensitivity study has the same bytes for any number of them") {
  if (!mpirun_is_here()) return;
  const Scratch scratch;
  std::ifstream in(hunting_servo, std::ios::binary);
  const std::string from = scratch.put("spread.toml", std::string(std::istreambuf_iterator<char>(in), {}) + R"(
[sensitivity]
samples = 64
parameters = [
  {path = "loop.friction.Fs", from = 0.9, to = 1.8},
  {path = "loop.friction.vs", distribution = "log-uniform", from = 1e-4, to = 1e-2},
]
)");
  same_documents({"sensitivity", from, "--factors", "1", "--threads", "2"}, {3});
}

TEST_CASE("ranks: killed and stopped at any moment, a map goes on where it was, and nothing is computed twice") {
  if (!mpirun_is_here()) return;
  const Scratch scratch;
  // Seconds on a fast machine: a rank must be hit before the end.
  const int columns = 4 * limcycle::test::samples(4);
  const Words map = map_of(std::to_string(columns), "12");
  const auto points = static_cast<std::size_t>(12 * columns);
  REQUIRE(run(map + Words{"--threads", "1", "--json", scratch.file("1.json")}).code == 0);
  const std::string store = scratch.file("store");
  const Words again = map + Words{"--threads", "1", "--store", store, "--resume", "--json", scratch.file("n.json")};
  std::random_device random;
  std::size_t known = 0;
  int ended_early = 0;
  enum { kill_one, stop_all, stop_one };
  for (const int how : {kill_one, stop_one, kill_one, stop_all}) {
    const int ranks = 2 + static_cast<int>(random() % 2);
    INFO("how " << how << ", " << ranks << " ranks, " << known << " points known");
    RankedJob job(scratch, ranks, again);
    const auto begin = std::chrono::steady_clock::now();
    while (stored(store) <= known && std::chrono::steady_clock::now() - begin < std::chrono::seconds(60))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 50));
    const auto pids = job.ranks();
    if (!pids.empty())
      kill(how == stop_all ? job.pid() : pids[random() % pids.size()], how == kill_one ? SIGKILL : SIGTERM);
    const Ran ran = job.wait();
    const auto now = limcycle::read_store(store);
    // Rows of this session are those that were not stored before.
    CHECK(now.activity.session_rows == now.activity.known - known);
    CHECK(now.activity.known > known);
    known = now.activity.known;
    if (known == points) break;
    ++ended_early;
    if (how == stop_one) {  // as for a single process
      CHECK(ran.code == 3);
      CHECK(times_in(ran.err, "continue by the same command with --resume") == 1);
    } else {
      CHECK(ran.code != 0);  // mpirun's
    }
  }
  CHECK(ended_early >= 2);
  REQUIRE(run_ranks(4, again).code == 0);
  CHECK(limcycle::read_store(store).activity.session_rows == points - known);
  CHECK(scratch.get("n.json") == scratch.get("1.json"));
  // A further run has nothing to do.
  std::filesystem::remove(scratch.file("n.json"));
  REQUIRE(run(again).code == 0);
  CHECK(limcycle::read_store(store).activity.session_rows == 0);
  CHECK(scratch.get("n.json") == scratch.get("1.json"));
}

TEST_CASE("ranks: an error comes once, from whichever rank") {
  if (!mpirun_is_here()) return;
  const Ran everywhere = run_ranks(3, {"map", "nowhere.toml", "--x", "a=1:2:3", "--y", "b=1:2:3"});
  CHECK(everywhere.code == 2);
  CHECK_THAT(everywhere.err, Contains("nowhere.toml: no such file"));
  CHECK(times_in(everywhere.err, "limcycle: ") == 1);

  // Rank 1 runs in another folder.
  const Scratch scratch;
  std::filesystem::create_directory(scratch.file("elsewhere"));
  std::filesystem::copy_file(hunting_servo, scratch.file("servo.toml"));
  const Words before{"sh", "-c",
                     "cd " + quoted(scratch.file("")) + "; [ $OMPI_COMM_WORLD_RANK != 1 ] || cd elsewhere; exec \"$@\"",
                     "sh"};
  const Words map{"map", "servo.toml", "--x", "loop.controller.kd=6:120:3", "--y", "loop.friction.Fs=1.1:1.5:2"};
  const Ran missing = run_ranks(3, map + Words{"--json", "map.json"}, before);
  CHECK(missing.code == 2);
  CHECK_THAT(missing.err, Contains("limcycle: rank 1 on ") && Contains("servo.toml: no such file"));
  CHECK(times_in(missing.err, "limcycle: ") == 1);
  CHECK(!std::filesystem::exists(scratch.file("map.json")));

  std::ofstream(scratch.file("elsewhere/servo.toml")) << scratch.get("servo.toml") << "\n# another one\n";
  const Ran other = run_ranks(3, map, before);
  CHECK(other.code == 2);
  CHECK_THAT(other.err, Contains("limcycle: rank 1 would compute another sweep"));
  CHECK(times_in(other.err, "limcycle: ") == 1);
}

TEST_CASE("ranks: a command without a sweep is done once") {
  if (!mpirun_is_here()) return;
  const Scratch scratch;
  const Ran alone = run({"check", hunting_servo});
  const Ran shared = run_ranks(3, {"check", hunting_servo, "--csv", scratch.file("n.csv")});
  CHECK(shared.code == 0);
  CHECK(shared.out == alone.out);
  CHECK(shared.err.empty());
  const Ran failing = run_ranks(2, {"check", "nowhere.toml"});
  CHECK(failing.code == 2);
  CHECK(times_in(failing.err, "limcycle: ") == 1);
}
