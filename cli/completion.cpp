// SPDX-License-Identifier: Apache-2.0
// Shell completion scripts, generated from the tables. Values complete to choices or to files; numbers do not complete.
//
// Each shell has its own syntax. Command names, spellings of options and quoted words are made once for all.
#include <fmt/format.h>

#include <algorithm>

#include "cli/command.h"
#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

std::string words_of(std::string_view choices) {
  std::string words(choices);
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

std::string command_names() {
  std::string names;
  for (const Command& command : commands()) names += fmt::format("{}{}", names.empty() ? "" : " ", command.name);
  return names;
}

std::string spelled(const Option& option) {
  return option.letter ? fmt::format("-{} --{}", option.letter, option.name) : fmt::format("--{}", option.name);
}

/// Escapes text for single quotes of a shell.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result;
}

std::string bash_script() {
  std::string values, flags;
  for_each_option([&](const Option& option) {
    if (option.is_switch()) return;
    // The pattern includes the command, because --format has different values for render and precision.
    std::string pattern;
    for (const Command& command : commands()) {
      if (!(option.commands & command.bit)) continue;
      if (!pattern.empty()) pattern += '|';
      if (option.letter) pattern += fmt::format("'{} -{}'|", command.name, option.letter);
      pattern += fmt::format("'{} --{}'", command.name, option.name);
    }
    const std::string reply = !option.choices().empty() ? fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))",
                                                                      words_of(option.choices()))
                              : option.is_file()        ? "COMPREPLY=($(compgen -f -- \"$word\"))"
                                                        : "COMPREPLY=()";
    values += fmt::format("    {}) {}; return ;;\n", pattern, reply);
  });
  for (const Command& command : commands()) {
    std::string names = command.bit ? "--help" : words_of(command.argument);
    for_each_option([&](const Option& option) {
      if (option.commands & command.bit) names += fmt::format(" {}", spelled(option));
    });
    flags += fmt::format("    {}) flags='{}' ;;\n", command.name, names);
  }
  return fmt::format(R"(# bash completion for frontmost
_frontmost() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} flags=
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$word"))
    return
  fi
  case "${{COMP_WORDS[1]}} $before" in
{}  esac
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "$flags" -- "$word")) ;;
    *) [ "${{COMP_WORDS[1]}}" = completion ] && COMPREPLY=($(compgen -W "$flags" -- "$word")) ||
         COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}}
complete -o filenames -F _frontmost frontmost
)",
                     command_names(), values, flags);
}

std::string zsh_argument(const Option& option) {
  std::string help(option.help);
  for (const char c : {'[', ']', ':'}) std::replace(help.begin(), help.end(), c, ' ');
  std::string argument;
  if (!option.choices().empty()) {
    argument = fmt::format(":value:({})", words_of(option.choices()));
  } else if (!option.is_switch()) {
    argument = fmt::format(":{}:{}", option.value, option.is_file() ? "_files" : " ");
  }
  const std::string letter =
      option.letter ? fmt::format("      '-{}[{}]{}' \\\n", option.letter, escaped(help), argument) : "";
  return letter + fmt::format("      '*--{}[{}]{}' \\\n", option.name, escaped(help), argument);
}

std::string zsh_script() {
  std::string summaries, cases;
  for (const Command& command : commands()) {
    summaries += fmt::format("    '{}:{}'\n", command.name, escaped(command.summary));
    std::string arguments;
    for_each_option([&](const Option& option) {
      if (option.commands & command.bit) arguments += zsh_argument(option);
    });
    const std::string positional = command.bit                ? "1:model:_files"
                                   : command.argument.empty() ? "1: : "
                                                              : fmt::format("1:shell:({})", words_of(command.argument));
    cases += fmt::format("    {})\n    _arguments \\\n{}      '{}' ;;\n", command.name, arguments, positional);
  }
  return fmt::format(R"(#compdef frontmost
_frontmost() {{
  local -a commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
compdef _frontmost frontmost
)",
                     summaries, cases);
}

std::string fish_script() {
  std::string script = "# fish completion for frontmost\n";
  for (const Command& command : commands()) {
    script += fmt::format("complete -c frontmost -n __fish_use_subcommand -f -a {} -d '{}'\n", command.name,
                          escaped(command.summary));
    if (!command.bit) {
      script += fmt::format("complete -c frontmost -n '__fish_seen_subcommand_from {}' -f -a '{}'\n", command.name,
                            words_of(command.argument));
    }
    for_each_option([&](const Option& option) {
      if (!(option.commands & command.bit)) return;
      script +=
          fmt::format("complete -c frontmost -n '__fish_seen_subcommand_from {}' -l {}", command.name, option.name);
      if (option.letter) script += fmt::format(" -s {}", option.letter);
      if (!option.choices().empty())
        script += fmt::format(" -x -a '{}'", words_of(option.choices()));
      else if (!option.is_switch())
        script += option.is_file() ? " -r" : " -x";
      script += fmt::format(" -d '{}'\n", escaped(option.help));
    });
  }
  return script;
}

}  // namespace

std::string completion_script(std::string_view shell) {
  if (shell == "bash") return bash_script();
  if (shell == "zsh") return zsh_script();
  if (shell == "fish") return fish_script();
  throw UsageError(fmt::format("completion: '{}' is not one of bash, zsh, fish", shell));
}

}  // namespace frontmost::cli
