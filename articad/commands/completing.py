"""Print shell scripts that complete commands."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from articad.commands.command import COMMANDS, argument, command

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal

_GLOBAL = ("--json", "--quiet", "--verbose", "--no-color", "--help")
_BASH = """\
_articad() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command="" i
  for ((i = 1; i < COMP_CWORD; i++)); do
    [[ ${{COMP_WORDS[i]}} != -* ]] && {{ command=${{COMP_WORDS[i]}}; break; }}
  done
  case "$command $before" in
{choices}
  esac
  if [[ -z $command ]]; then
    COMPREPLY=($(compgen -W "{commands} {flags} --version" -- "$word"))
    return
  fi
  if [[ $word == -* ]]; then
    case $command in
{options}
    esac
    return
  fi
  COMPREPLY=($(compgen -f -- "$word"))
}}
complete -o filenames -F _articad articad
"""
_ZSH = "autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n"


@command(
    "completion",
    'Print a shell script that completes articad\'s commands: eval "$(articad completion bash)".',
    argument("shell", choices=["bash", "zsh", "fish"]),
    needs_libraries=False,
)
def _completion(options: argparse.Namespace, terminal: Terminal) -> Report:
    text = _fish() if options.shell == "fish" else (_ZSH if options.shell == "zsh" else "") + _bash()
    terminal.text(text.rstrip("\n"))
    return {"schema": "articad.completion/1", "ok": True, "script": text, "findings": []}


def _flags(name: str) -> list[tuple[str, str, tuple[str, ...]]]:
    """Return a command's long flags with their help and choices."""
    parser = argparse.ArgumentParser(add_help=False)
    COMMANDS[name].arguments(parser)
    return [
        (flag, action.help or "", tuple(map(str, action.choices or ())))
        for action in parser._actions  # noqa: SLF001 - argparse keeps its list of flags nowhere else
        for flag in action.option_strings
        if flag.startswith("--")
    ]


def _bash() -> str:
    choices, options = [], []
    for name in sorted(COMMANDS):
        flags = _flags(name)
        options.append(f'      {name}) COMPREPLY=($(compgen -W "{" ".join([*(flag for flag, _, _ in flags), *_GLOBAL])}" -- "$word")) ;;')
        choices += [
            f'    "{name} {flag}") COMPREPLY=($(compgen -W "{" ".join(words)}" -- "$word")); return ;;' for flag, _, words in flags if words
        ]
    choices.append('    "completion completion") COMPREPLY=($(compgen -W "bash zsh fish" -- "$word")); return ;;')
    return _BASH.format(
        choices="\n".join(choices), options="\n".join(options), commands=" ".join(sorted(COMMANDS)), flags=" ".join(_GLOBAL)
    )


def _fish() -> str:
    def quoted(text: str) -> str:
        return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"

    lines = [f"complete -c articad -n __fish_use_subcommand -a {name} -d {quoted(COMMANDS[name].summary)}" for name in sorted(COMMANDS)]
    lines += [f"complete -c articad -l {flag[2:]}" for flag in _GLOBAL]
    for name in sorted(COMMANDS):
        for flag, told, words in _flags(name):
            chosen = f" -x -a {quoted(' '.join(words))}" if words else ""
            lines.append(f"complete -c articad -n '__fish_seen_subcommand_from {name}' -l {flag[2:]} -d {quoted(told)}{chosen}")
    lines.append("complete -c articad -n '__fish_seen_subcommand_from completion' -x -a 'bash zsh fish'")
    return "\n".join(lines) + "\n"
