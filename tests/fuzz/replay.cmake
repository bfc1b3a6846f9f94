# SPDX-License-Identifier: Apache-2.0
# The fuzz targets over their corpora as ordinary tests, in the tree with AddressSanitizer: no fuzzing, no tree of their own.
set(targets
    fuzz_device
    fuzz_encrypted_recording
    fuzz_exercise
    fuzz_link
    fuzz_mesh
    fuzz_motion
    fuzz_opengloves
    fuzz_recording
    fuzz_scene)
set(sources ${CMAKE_CURRENT_LIST_DIR}/replay_test.cpp)
foreach(target ${targets})
  set(source ${CMAKE_CURRENT_LIST_DIR}/${target}.cpp)
  set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS LLVMFuzzerTestOneInput=${target} SKIP_UNITY_BUILD_INCLUSION ON)
  list(APPEND sources ${source})
endforeach()
phalanx_test(
  fuzz_replay_test
  IN_ASAN
  SOURCES ${sources}
  MODULES mcap exercise_file exercise scores psychophysics scene opengloves grasp simulation device step force contact hand mesh_import mesh
  LIBRARIES phalanx_wire assimp::assimp fmt::fmt nlohmann_json::nlohmann_json tomlplusplus::tomlplusplus Threads::Threads)
