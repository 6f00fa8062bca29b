# The ParaView part: the module in Filters/ and the plugin in Plugin/, both made here so that a build
# with ROCKFALL_PLUGIN=OFF needs neither VTK nor ParaView.
include(GNUInstallDirs)

include("${CMAKE_CURRENT_LIST_DIR}/DebianPython.cmake")

# Named components only: a bare find_package(ParaView) asks for Qt's development packages too.
find_package(ParaView 5.11 REQUIRED COMPONENTS
  RemotingCore RemotingServerManager VTKExtensionsCore WrapClientServer ProcessXML)

# The window's part takes Qt; a batch run does without.
option(ROCKFALL_WINDOW "Build the Rockfall menu and looks of ParaView's window, if Qt is there" ON)
set(ROCKFALL_QT Qt5)
if(ParaView_VERSION VERSION_GREATER_EQUAL 5.13)
  set(ROCKFALL_QT Qt6)
endif()
if(ROCKFALL_WINDOW)
  find_package(${ROCKFALL_QT} QUIET COMPONENTS Widgets)
  if(ROCKFALL_QT STREQUAL "Qt6")
    find_package(Qt6 QUIET OPTIONAL_COMPONENTS Help) # here: a folder sees the targets that were there before it
  endif()
endif()
set(ROCKFALL_HAS_WINDOW OFF)
if(ROCKFALL_WINDOW AND TARGET ${ROCKFALL_QT}::Widgets AND TARGET ParaView::pqApplicationComponents)
  set(ROCKFALL_HAS_WINDOW ON)
else()
  message(STATUS "No ${ROCKFALL_QT} (Debian: qtbase5-dev or qt6-base-dev), so no Rockfall menu")
endif()

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")

set(plugin_files "${CMAKE_CURRENT_LIST_DIR}/paraview.plugin")
if(ROCKFALL_HAS_WINDOW)
  list(APPEND plugin_files "${CMAKE_CURRENT_LIST_DIR}/window/paraview.plugin")
endif()
paraview_plugin_scan(
  PLUGIN_FILES ${plugin_files}
  PROVIDES_PLUGINS rockfall_plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)

paraview_plugin_build(
  PLUGINS ${rockfall_plugins}
  AUTOLOAD ${rockfall_plugins}
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
  PLUGINS_FILE_NAME "rockfall.xml"
  INSTALL_HEADERS OFF
  # The pages behind ? are those of docs/, see below.
  DISABLE_XML_DOCUMENTATION ON)

# What VTK makes of the classes for ParaView's scripts: the headers cost more than the classes.
if(TARGET RockfallFiltersCS)
  set_target_properties(RockfallFiltersCS PROPERTIES UNITY_BUILD ${ROCKFALL_UNITY} UNITY_BUILD_BATCH_SIZE 0)
endif()

# The folders to name in PV_PLUGIN_PATH, of the plugin and of what only a window needs.
set(ROCKFALL_PLUGIN_FOLDER
  "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallDDA")
set(ROCKFALL_WINDOW_FOLDER "")
if(ROCKFALL_HAS_WINDOW)
  set(ROCKFALL_WINDOW_FOLDER
    "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallWindow")
  # In a folder of their own: ParaView takes every script beside a plugin for a plugin.
  set(scripts "${CMAKE_CURRENT_LIST_DIR}/window/rockfall_study.py"
    "${PROJECT_SOURCE_DIR}/Examples/sample_dem.py")
  set(script_folder "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallScripts")
  file(MAKE_DIRECTORY "${script_folder}")
  foreach(script ${scripts})
    configure_file("${script}" "${script_folder}" COPYONLY)
  endforeach()
  install(FILES ${scripts}
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallScripts")
  # What the menu's report is made with, as it lies in Examples/.
  set(examples "${PROJECT_SOURCE_DIR}/Examples")
  file(GLOB report_scripts CONFIGURE_DEPENDS RELATIVE "${examples}" "${examples}/report.py" "${examples}/rockfall_tables.py"
    "${examples}/report_parts/*.*" "${examples}/study_parts/*.py")
  foreach(script ${report_scripts})
    configure_file("${examples}/${script}" "${script_folder}/report/${script}" COPYONLY)
    get_filename_component(folder "${script}" DIRECTORY)
    install(FILES "${examples}/${script}"
      DESTINATION "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallScripts/report/${folder}")
  endforeach()
  set(presets "${PROJECT_SOURCE_DIR}/docs/materials.md") # which the report quotes
  configure_file("${presets}" "${script_folder}/docs/materials.md" COPYONLY)
  install(FILES "${presets}" DESTINATION "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallScripts/docs")

  # The pages behind ?, of docs/: one file that the window opens. It wants Qt's help generator.
  find_program(ROCKFALL_QHELPGENERATOR qhelpgenerator PATHS /usr/lib/qt5/bin /usr/lib/qt6/bin /usr/lib/qt6/libexec)
  # Debian's Python, where there is one: it has matplotlib, which draws formulas.
  find_program(ROCKFALL_PAGE_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
  find_program(ROCKFALL_PAGE_PYTHON python3)
  if(ROCKFALL_QHELPGENERATOR AND ROCKFALL_PAGE_PYTHON)
    set(pages "${script_folder}/RockfallDDA.qch")
    file(GLOB page_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/*.md" "${CMAKE_CURRENT_LIST_DIR}/xml/*.xml")
    add_custom_command(
      OUTPUT "${pages}"
      COMMAND "${ROCKFALL_PAGE_PYTHON}" "${CMAKE_CURRENT_LIST_DIR}/help/makePages.py" "${PROJECT_SOURCE_DIR}/docs"
        "${CMAKE_CURRENT_LIST_DIR}/xml" "${CMAKE_BINARY_DIR}/pages"
      COMMAND "${ROCKFALL_QHELPGENERATOR}" "${CMAKE_BINARY_DIR}/pages/RockfallDDA.qhp" -o "${pages}"
      DEPENDS ${page_sources} "${CMAKE_CURRENT_LIST_DIR}/help/makePages.py"
      COMMENT "Making the pages behind ?"
      VERBATIM)
    add_custom_target(RockfallPages ALL DEPENDS "${pages}")
    add_dependencies(RockfallWindow RockfallPages)
    # Qt 6's help engine has to be opened for them.
    if(TARGET Qt6::Help)
      target_link_libraries(RockfallWindow PRIVATE Qt6::Help)
      target_compile_definitions(RockfallWindow PRIVATE ROCKFALL_OPENS_HELP)
    elseif(ROCKFALL_QT STREQUAL "Qt6")
      message(STATUS "No Qt6Help (Debian: qt6-tools-dev), so the help window stays empty")
    endif()
    install(FILES "${pages}" DESTINATION "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallScripts")
  else()
    message(STATUS "No qhelpgenerator (Debian: qttools5-dev-tools), so no pages behind ?")
  endif()
endif()

# All that ParaView loads, with or without a window.
add_custom_target(RockfallPlugins DEPENDS ${rockfall_plugins})
