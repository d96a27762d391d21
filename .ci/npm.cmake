# probe_npm(SOURCE BUILD WHAT [option..]): installs the packages of SOURCE/package-lock.json, exactly those, into
# BUILD/node_modules, from npm's cache where it has them, so a build without network works after the first. What needs them
# depends on BUILD/node_modules/.package-lock.json. WHAT says in a mistake whose packages they are.
include_guard(GLOBAL)
find_program(VLAPROBE_NPM npm)
find_program(VLAPROBE_NODE NAMES node nodejs)
if(NOT VLAPROBE_NPM OR NOT VLAPROBE_NODE)
  message(FATAL_ERROR "parts of this project are bundled with npm and node, which are not here: run .ci/install, or apt-get install npm")
endif()
function(probe_npm source build what)
  set(fetch "${VLAPROBE_NPM} ci --ignore-scripts --prefer-offline --no-audit --no-fund --loglevel=error ${ARGN} >npm.log 2>&1 || { cat npm.log >&2; echo 'the packages of ${what} could not be installed (npm above): connect this machine to a registry once, or copy a filled npm cache' >&2; exit 2; }")
  add_custom_command(
    OUTPUT ${build}/node_modules/.package-lock.json
    COMMAND ${CMAKE_COMMAND} -E make_directory ${build}
    COMMAND ${CMAKE_COMMAND} -E copy ${source}/package.json ${source}/package-lock.json ${build}
    COMMAND sh -c "cd ${build} && ${fetch}"
    COMMAND ${CMAKE_COMMAND} -E touch ${build}/node_modules/.package-lock.json
    DEPENDS ${source}/package.json ${source}/package-lock.json
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
    COMMENT "Installing the packages of ${what}" VERBATIM)
endfunction()
