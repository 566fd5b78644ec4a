# shellcheck shell=bash
# Shared by the scripts that build; sourced, with the repository as the working folder.

# build_jobs: as many compilers as there are processors and memory (about 1.5 GB each).
build_jobs() {
  local processors memory_kb by_memory
  processors=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo 2>/dev/null || true)
  by_memory=$(((${memory_kb:-1500000} + 750000) / 1500000))
  ((by_memory < processors)) && processors=$by_memory
  echo $((processors > 1 ? processors : 1))
}

# install_node: what the viewer is built with, unless it is there from anywhere; ldso can be built without.
install_node() {
  command -v node >/dev/null && command -v npm >/dev/null && return
  scripts/install_packages.sh viewer || echo "no Node: ldso is built without its viewer"
}

# Without this ccache does not keep what was compiled with precompiled headers.
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}

# configure PRESET [CMAKE OPTIONS...]
configure() {
  if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
  cmake --preset "$@"
}

# build PRESET [OPTIONS OF cmake --build...]
build() { cmake --build --preset "$@" --parallel "$(build_jobs)"; }
