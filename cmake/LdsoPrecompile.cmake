# Headers that nearly every source includes are parsed once for many targets: cmake/precompiled*.h.
option(LDSO_PRECOMPILE_HEADERS "Parse the common headers once" ON)

# ldso_precompile(<target> <header> sources...): targets with the same header share it; they need the same flags. Kernels
# are compiled for several instruction sets and must not see Eigen, whose inline functions would be compiled with
# instructions that other machines do not have: they go without.
function(ldso_precompile target header)
  if(NOT LDSO_PRECOMPILE_HEADERS)
    return()
  endif()
  get_property(first GLOBAL PROPERTY LDSO_FIRST_WITH_${header})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/${header})
    set_property(GLOBAL PROPERTY LDSO_FIRST_WITH_${header} ${target})
  endif()
  set(kernels ${ARGN})
  list(FILTER kernels INCLUDE REGEX "_kernels(_reference)?\\.cpp$")
  set_source_files_properties(${kernels} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
