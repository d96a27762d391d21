# The report page: TypeScript, style and charts bundled by esbuild into one generated source of probe_report. Packages are
# exactly those of package-lock.json, from npm's cache where it has them, so a build without network works after the first.
# They are the studio's, too (runtime/studio/page/page.cmake).
include(${PROJECT_SOURCE_DIR}/.ci/npm.cmake)
set(page_source ${CMAKE_CURRENT_LIST_DIR})
set(VLAPROBE_PAGE_BUILD ${CMAKE_BINARY_DIR}/report_page)
file(GLOB_RECURSE page_inputs CONFIGURE_DEPENDS ${page_source}/src/*.ts ${page_source}/src/*.css)
# puppeteer-core and TypeScript are for tests only.
set(page_omit $<$<NOT:$<BOOL:${VLAPROBE_TESTS}>>:--omit=dev>)
probe_npm(${page_source} ${VLAPROBE_PAGE_BUILD} runtime/report/page ${page_omit})
add_custom_command(
  OUTPUT ${VLAPROBE_PAGE_BUILD}/page_template.cpp
  COMMAND ${VLAPROBE_NODE} ${page_source}/build.mjs ${VLAPROBE_PAGE_BUILD}
  DEPENDS ${VLAPROBE_PAGE_BUILD}/node_modules/.package-lock.json ${page_source}/build.mjs ${page_source}/licences.mjs ${page_inputs}
  COMMENT "Bundling the report page" VERBATIM)
target_sources(probe_report PRIVATE ${VLAPROBE_PAGE_BUILD}/page_template.cpp)
