# The report page: TypeScript, style and charts bundled by esbuild into one generated source of probe_report. Packages are
# exactly those of package-lock.json, from npm's cache where it has them, so a build without network works after the first.
find_program(VLAPROBE_NPM npm)
find_program(VLAPROBE_NODE NAMES node nodejs)
if(NOT VLAPROBE_NPM OR NOT VLAPROBE_NODE)
  message(FATAL_ERROR "the report page is bundled with npm and node, which are not here: run .ci/install, or apt-get install npm")
endif()
set(page_source ${CMAKE_CURRENT_LIST_DIR})
set(VLAPROBE_PAGE_BUILD ${CMAKE_BINARY_DIR}/report_page)
file(GLOB_RECURSE page_inputs CONFIGURE_DEPENDS ${page_source}/src/*.ts ${page_source}/src/*.css)
# puppeteer-core and TypeScript are for tests only.
set(page_omit $<$<NOT:$<BOOL:${VLAPROBE_TESTS}>>:--omit=dev>)
set(page_fetch "${VLAPROBE_NPM} ci --ignore-scripts --prefer-offline --no-audit --no-fund --loglevel=error ${page_omit} >npm.log 2>&1 || { cat npm.log >&2; echo 'the packages of runtime/report/page could not be installed (npm above): connect this machine to a registry once, or copy a filled npm cache' >&2; exit 2; }")
add_custom_command(
  OUTPUT ${VLAPROBE_PAGE_BUILD}/node_modules/.package-lock.json
  COMMAND ${CMAKE_COMMAND} -E make_directory ${VLAPROBE_PAGE_BUILD}
  COMMAND ${CMAKE_COMMAND} -E copy ${page_source}/package.json ${page_source}/package-lock.json ${VLAPROBE_PAGE_BUILD}
  COMMAND sh -c "cd ${VLAPROBE_PAGE_BUILD} && ${page_fetch}"
  COMMAND ${CMAKE_COMMAND} -E touch ${VLAPROBE_PAGE_BUILD}/node_modules/.package-lock.json
  DEPENDS ${page_source}/package.json ${page_source}/package-lock.json
  WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
  COMMENT "Installing the report page's packages" VERBATIM)
add_custom_command(
  OUTPUT ${VLAPROBE_PAGE_BUILD}/page_template.cpp
  COMMAND ${VLAPROBE_NODE} ${page_source}/build.mjs ${VLAPROBE_PAGE_BUILD}
  DEPENDS ${VLAPROBE_PAGE_BUILD}/node_modules/.package-lock.json ${page_source}/build.mjs ${page_inputs}
  COMMENT "Bundling the report page" VERBATIM)
target_sources(probe_report PRIVATE ${VLAPROBE_PAGE_BUILD}/page_template.cpp)
