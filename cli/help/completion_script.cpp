#include "limcycle/cli/help/completion_script.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace limcycle {
namespace {

/// Completions that the shell offers for a value.
enum class Offer { nothing, words, files, cases, cases_and_words };

Offer offer_of(const OptionFacts& option) {
  if (option.name == "CASE") return Offer::cases;
  if (option.value == "ID|CASE") return Offer::cases_and_words;
  if (!option.choices.empty()) return Offer::words;
  return option.value == "FILE" || option.value == "FILE|-" ? Offer::files : Offer::nothing;
}

const OptionFacts* argument_of(const CommandFacts& command) {
  const auto found = std::ranges::find(command.options, true, &OptionFacts::argument);
  return found == command.options.end() ? nullptr : &*found;
}

std::string words_of(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::vector<std::string> flags_of(const CommandFacts& command) {
  std::vector<std::string> flags;
  for (const auto& option : command.options) {
    if (option.argument) continue;
    flags.push_back(option.name);
    if (!option.letter.empty()) flags.push_back(option.letter);
  }
  return flags;
}

/// Quotes a text in single quotes.
std::string quoted_in_shell(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string bash_offer(const OptionFacts& option) {
  switch (offer_of(option)) {
    case Offer::words:
      return fmt::format("words='{}'", words_of(option.choices));
    case Offer::files:
      return "files='*'";
    case Offer::cases:
      return "files='*.toml'";
    case Offer::cases_and_words:
      return fmt::format("words='{}' files='*.toml'", words_of(option.choices));
    case Offer::nothing:
      break;
  }
  return "return";
}

/// Lines of the `case` over "COMMAND OPTION" that give the values of an option.
std::string bash_values(const CommandFacts& command) {
  std::string text;
  for (const auto& option : command.options) {
    if (option.argument || option.value.empty()) continue;
    const auto key = [&](const std::string& name) {
      return option.common ? "*' " + name + "'" : "'" + command.name + " " + name + "'";
    };
    text += "    " + key(option.name) + (option.letter.empty() ? "" : " | " + key(option.letter)) + ")";
    text += " " + bash_offer(option) + " ;;\n";
  }
  return text;
}

std::string zsh_action(const OptionFacts& option) {
  const std::string label = option.value.empty() ? option.name : option.value;
  std::string clean;
  for (const char c : label) clean += c == ':' || c == '[' || c == ']' ? ' ' : c;
  const std::string words = "(" + words_of(option.choices) + ")";
  switch (offer_of(option)) {
    case Offer::words:
      return ":" + clean + ":" + words;
    case Offer::files:
      return ":" + clean + ":_files";
    case Offer::cases:
      return ":" + clean + ":_files -g \"*.toml(-.)\"";
    case Offer::cases_and_words:
      return ":" + clean + ":{ compadd " + words_of(option.choices) + "; _files -g \"*.toml(-.)\" }";
    case Offer::nothing:
      break;
  }
  return ":" + clean + ": ";
}

/// Escapes brackets and colons, which have a meaning for `_arguments`.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '[' || c == ']' || c == ':' ? std::string("\\") + c : std::string(1, c);
  return out;
}

std::string zsh_specification(const OptionFacts& option) {
  if (option.argument) return "'*" + quoted_in_shell(zsh_action(option)).substr(1);
  const std::string tail = "[" + zsh_text(option.meaning) + "]" + (option.value.empty() ? "" : zsh_action(option));
  std::string text = quoted_in_shell("*" + option.name + tail);
  if (!option.letter.empty()) text += " \\\n        " + quoted_in_shell("*" + option.letter + tail);
  return text;
}

std::string fish_line(const std::string& condition, const std::string& rest) {
  return fmt::format("complete -c limcycle -n '{}' {}\n", condition, rest);
}

std::string fish_offer(const OptionFacts& option) {
  const std::string words = quoted_in_shell(words_of(option.choices));
  switch (offer_of(option)) {
    case Offer::words:
      return " -f -a " + words;
    case Offer::files:
      return " -F";
    case Offer::cases:
      return " -k -f -a '(__fish_complete_suffix .toml)'";
    case Offer::cases_and_words:
      return " -k -f -a " + quoted_in_shell("(__fish_complete_suffix .toml) " + words_of(option.choices));
    case Offer::nothing:
      break;
  }
  return " -f";
}

}  // namespace

std::string bash_completion(const std::vector<CommandFacts>& commands) {
  std::vector<std::string> names;
  std::string values, flags;
  for (const auto& command : commands) {
    names.push_back(command.name);
    // Common options are written once, those of the first command that has most of them.
    CommandFacts without = command;
    std::erase_if(without.options, [](const OptionFacts& one) { return one.common; });
    values += bash_values(without);
    const OptionFacts* argument = argument_of(command);
    flags += fmt::format("    {})\n      flags='{}'\n", command.name, words_of(flags_of(command)));
    if (argument != nullptr) flags += "      [[ $cur == -* ]] || " + bash_offer(*argument) + "\n";
    flags += "      ;;\n";
  }
  const auto most = std::ranges::max_element(
      commands, {}, [](const auto& one) { return std::ranges::count(one.options, true, &OptionFacts::common); });
  CommandFacts common = *most;
  std::erase_if(common.options, [](const OptionFacts& one) { return !one.common; });
  values += bash_values(common);
  return fmt::format(R"(# Completion of limcycle for bash; made by `limcycle completion bash`.
_limcycle() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev='' command='' words='' files='' flags=''
  COMPREPLY=()
  ((COMP_CWORD > 0)) && prev=${{COMP_WORDS[COMP_CWORD - 1]}}
  # bash splits --option=value at the sign
  if [[ $cur == '=' ]]; then
    cur=''
  elif [[ $prev == '=' ]] && ((COMP_CWORD > 1)); then
    prev=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  ((COMP_CWORD > 1)) && command=${{COMP_WORDS[1]}}
  if [[ -z $command ]]; then
    mapfile -t COMPREPLY < <(compgen -W '{0} --help --version' -- "$cur")
    return
  fi
  case "$command $prev" in
{1}    *)
      case $command in
{2}      esac
      ;;
  esac
  [[ $cur == -* && -z $words$files ]] && words=$flags
  [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
  if [[ -n $files ]]; then
    local file
    compopt -o filenames 2>/dev/null
    while IFS= read -r file; do
      # shellcheck disable=SC2053  # a pattern
      [[ -d $file || $file == $files ]] && COMPREPLY+=("$file")
    done < <(compgen -f -- "$cur")
  fi
}}
complete -F _limcycle limcycle
)",
                     words_of(names), values, flags);
}

std::string zsh_completion(const std::vector<CommandFacts>& commands) {
  std::string names, cases;
  for (const auto& command : commands) {
    names += "      " + quoted_in_shell(command.name + ":" + command.summary) + "\n";
    cases += "    " + command.name + ")\n      _arguments";
    for (const auto& option : command.options) cases += " \\\n        " + zsh_specification(option);
    cases += "\n      ;;\n";
  }
  return "#compdef limcycle\n# Completion of limcycle for zsh; made by `limcycle completion zsh`.\n"
         "_limcycle() {\n  local -a commands\n  if (( CURRENT == 2 )); then\n    commands=(\n" +
         names +
         "    )\n    _describe 'command' commands\n    return\n  fi\n"
         "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n" +
         cases +
         "  esac\n}\nif [[ $funcstack[1] == _limcycle ]]; then\n  _limcycle \"$@\"\nelse\n"
         "  compdef _limcycle limcycle\nfi\n";
}

std::string fish_completion(const std::vector<CommandFacts>& commands) {
  std::string text =
      "# Completion of limcycle for fish; made by `limcycle completion fish`.\ncomplete -c limcycle -f\n";
  for (const auto& command : commands)
    text += fish_line("__fish_use_subcommand", "-a " + command.name + " -d " + quoted_in_shell(command.summary));
  for (const auto& command : commands) {
    const std::string here = "__fish_seen_subcommand_from " + command.name;
    for (const auto& option : command.options) {
      if (option.argument) {
        text += fish_line(here, fish_offer(option).substr(1));
        continue;
      }
      std::string rest = "-l " + option.name.substr(2);
      if (!option.letter.empty()) rest += " -s " + option.letter.substr(1);
      if (!option.value.empty()) rest += " -r" + fish_offer(option);
      text += fish_line(here, rest + " -d " + quoted_in_shell(option.meaning));
    }
  }
  return text;
}

}  // namespace limcycle
