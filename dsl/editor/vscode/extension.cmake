# `ninja vscode_extension` makes vscode/probe-language.vsix in the build folder; nothing else needs it.
set(vscode_build ${CMAKE_BINARY_DIR}/vscode)
file(GLOB vscode_inputs CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/src/*.ts ${CMAKE_CURRENT_LIST_DIR}/syntaxes/*.json)
probe_npm(${CMAKE_CURRENT_LIST_DIR} ${vscode_build} dsl/editor/vscode)
add_custom_command(
  OUTPUT ${vscode_build}/probe-language.vsix
  COMMAND ${VLAPROBE_NODE} ${CMAKE_CURRENT_LIST_DIR}/build.mjs ${vscode_build} ${vscode_build}/probe-language.vsix >${vscode_build}/vsix.log 2>&1
          || ( cat ${vscode_build}/vsix.log >&2 && false )
  DEPENDS ${vscode_build}/node_modules/.package-lock.json ${vscode_inputs} ${CMAKE_CURRENT_LIST_DIR}/build.mjs
          ${CMAKE_CURRENT_LIST_DIR}/README.md ${CMAKE_CURRENT_LIST_DIR}/language-configuration.json
  COMMENT "Packing the extension for VS Code")
# What a test packs it with.
add_custom_target(vscode_packages DEPENDS ${vscode_build}/node_modules/.package-lock.json)
add_custom_target(vscode_extension DEPENDS ${vscode_build}/probe-language.vsix)
