# The ParaView part: the module in Filters/ and the plugin in Plugin/, both made here so that a build
# with ROCKFALL_PLUGIN=OFF needs neither VTK nor ParaView.
include(GNUInstallDirs)

# Named components only: a bare find_package(ParaView) asks for Qt's development packages too.
find_package(ParaView 5.11 REQUIRED COMPONENTS
  RemotingCore RemotingServerManager VTKExtensionsCore WrapClientServer ProcessXML)

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")

paraview_plugin_scan(
  PLUGIN_FILES "${CMAKE_CURRENT_LIST_DIR}/paraview.plugin"
  PROVIDES_PLUGINS rockfall_plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)

# Without XML documentation: the HTML help wants Qt's help generator, and every text of it is in the
# property panel already.
paraview_plugin_build(
  PLUGINS ${rockfall_plugins}
  AUTOLOAD ${rockfall_plugins}
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
  PLUGINS_FILE_NAME "rockfall.xml"
  INSTALL_HEADERS OFF
  DISABLE_XML_DOCUMENTATION ON)

# The folder to name in PV_PLUGIN_PATH.
set(ROCKFALL_PLUGIN_FOLDER
  "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallDDA")
