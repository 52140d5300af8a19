#include <CLI/CLI.hpp>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/help/completion_script.hpp"
#include "limcycle/cli/output/output.hpp"

namespace limcycle {
namespace {

std::string completion(const CLI::App& program, const std::string& shell) {
  const auto commands = facts_of(program);
  if (shell == "bash") return bash_completion(commands);
  if (shell == "zsh") return zsh_completion(commands);
  if (shell == "fish") return fish_completion(commands);
  throw refusal("completion", "unknown shell '" + shell + "'",
                suggest(shell, std::vector<std::string>{"bash", "zsh", "fish"}));
}

void add_completion(CLI::App& program, Action& action) {
  const auto flags = std::make_shared<CommonFlags>();
  const auto shell = std::make_shared<std::string>();
  CLI::App* command =
      add_plain_command(program, action, "completion", "Print a script that completes commands and options in a shell",
                        flags, [&program, flags, shell] {
                          flags->color = "never";
                          Output output(*flags);
                          output.text(completion(program, *shell));
                          output.finish();
                          return static_cast<int>(exit_done);
                        });
  command->add_option("SHELL", *shell, "bash, zsh or fish")->type_name("SHELL")->required();
}

}  // namespace

Command completion_command() {
  return {{"completion",
           install_group,
           "Prints a script that lets the shell complete commands, options, names and files.",
           {{"limcycle completion bash > limcycle.bash", "then: source limcycle.bash, in ~/.bashrc"},
            {"limcycle completion zsh > _limcycle", "into a folder of $fpath"},
            {"limcycle completion fish > limcycle.fish", "into ~/.config/fish/completions"}}},
          add_completion};
}

}  // namespace limcycle
