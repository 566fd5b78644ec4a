# Completion of ldso for bash: commands and options as its own help lists them, the values that an option takes, names of
# settings after --set, and files for the rest.
_ldso() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} commands=() word help
  COMPREPLY=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word =~ ^[a-z]+$ ]] || break
    commands+=("$word")
    ((${#commands[@]} == 2)) && break
  done
  help=$(ldso "${commands[@]}" --help 2>/dev/null) || help=$(ldso "${commands[@]:0:1}" --help 2>/dev/null) || return 0

  if [[ $before == --set ]]; then
    mapfile -t COMPREPLY < <(compgen -S = -W "$(ldso settings --expert | awk '/^  [a-z_.]+ / { print $1 }')" -- "$current")
    compopt -o nospace 2>/dev/null
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '^  (-[a-z],)?--[a-z][a-z-]*' <<<"$help" | tr ', ' '\n\n')" -- "$current")
  else
    # What stands in braces after an option's name, or else the commands, or the values of the first argument.
    local choices
    choices=$(sed -nE -- "s/^ +(-[a-z],)?$before [A-Z]+:\{([^}]*)\}.*/\2/p" <<<"$help" | tr ',' '\n')
    if [[ -z $choices && $before != -* ]]; then
      choices=$(awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { print $1 }' <<<"$help")
      ((${#commands[@]} == COMP_CWORD - 1)) &&
        choices+=" $(sed -nE '/^Positionals:/,/^$/s/^ +[a-z]+ TEXT:\{([^}]*)\}.*/\1/p' <<<"$help" | tr ',' '\n')"
    fi
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
  fi
  ((${#COMPREPLY[@]} > 0)) || mapfile -t COMPREPLY < <(compgen -f -- "$current")
}
complete -o filenames -F _ldso ldso
