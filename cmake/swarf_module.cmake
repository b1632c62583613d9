# swarf_module(<name> [DEPENDS <modules>...] [LIBRARIES <third-party targets>...])
# One static library from every .cpp of the calling folder, known to others as swarf::<name>.
# LIBRARIES stay private: heavy libraries are seen by the .cpp files of one folder only.
function(swarf_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBRARIES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  list(TRANSFORM ARG_DEPENDS PREPEND "swarf::")
  if(sources)
    add_library(swarf_${name} STATIC ${sources})
    target_link_libraries(swarf_${name} PUBLIC ${ARG_DEPENDS} swarf_settings PRIVATE ${ARG_LIBRARIES})
    swarf_unity(swarf_${name})
  else()
    add_library(swarf_${name} INTERFACE)
    target_link_libraries(swarf_${name} INTERFACE ${ARG_DEPENDS} swarf_settings)
  endif()
  add_library(swarf::${name} ALIAS swarf_${name})
endfunction()

# swarf_unity(<target> [<files>]): several .cpp of the target are compiled as one, so that the headers they share
# (Eigen, OpenVDB, JSON, GoogleTest: most of the time of a build) are read once for all of them. Files with flags of
# their own stay alone. Names in anonymous namespaces are therefore unique within a target.
function(swarf_unity target)
  if(SWARF_UNITY)
    set(files 8)
    if(ARGC GREATER 1)
      set(files ${ARGV1})
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()

# Flags that every file shares.
add_library(swarf_settings INTERFACE)
target_include_directories(swarf_settings INTERFACE
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/engine>" "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>"
  "$<INSTALL_INTERFACE:include/swarf>")
target_link_libraries(swarf_settings INTERFACE Eigen3::Eigen fmt::fmt Threads::Threads)
# -ffp-contract=off: with fused multiply-add, results would depend on the instruction set.
# -fno-semantic-interposition: nobody replaces our functions at run time, so that position independent code costs nothing.
# No -march here: Debian's libraries use Eigen with 16-byte alignment; only kernel files carry their own flags.
target_compile_definitions(swarf_settings INTERFACE SWARF_VERSION="${PROJECT_VERSION}")
target_compile_options(swarf_settings INTERFACE
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wshadow;-fno-semantic-interposition>" -Wno-psabi -ffp-contract=off)
target_compile_features(swarf_settings INTERFACE cxx_std_20)
