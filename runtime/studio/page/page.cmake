# The studio's page: TypeScript, style, Monaco and charts bundled by esbuild into one generated source of probe_studio. Its
# packages are those of the report page, which installs them.
set(studio_page ${CMAKE_CURRENT_LIST_DIR})
set(report_page ${PROJECT_SOURCE_DIR}/runtime/report/page)
set(packages ${CMAKE_BINARY_DIR}/report_page)
set(studio_page_build ${CMAKE_BINARY_DIR}/studio_page)
file(GLOB_RECURSE studio_page_inputs CONFIGURE_DEPENDS ${studio_page}/src/*)
add_custom_command(
  OUTPUT ${studio_page_build}/page_files.cpp
  COMMAND ${VLAPROBE_NODE} ${studio_page}/build.mjs ${packages} ${studio_page_build}
  # The packages through what the report page makes of them, so that one rule alone installs them.
  DEPENDS ${packages}/page_template.cpp ${studio_page}/build.mjs ${report_page}/licences.mjs ${report_page}/src/dom.ts
          ${report_page}/src/theme.ts ${studio_page_inputs}
  COMMENT "Bundling the studio's page" VERBATIM)
target_sources(probe_studio PRIVATE ${studio_page_build}/page_files.cpp)
add_dependencies(probe_studio probe_report)
