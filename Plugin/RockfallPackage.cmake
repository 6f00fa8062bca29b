# Files that `cmake --install` puts beside the plugin, and the .deb that `cpack` makes of it. A plugin works with
# the ParaView that it was built for and with no other one, so there is a package for each release of
# Debian, made on it: dpkg-shlibdeps names the exact libraries.
# Of use to nobody who only loads the plugin.
install(CODE "file(REMOVE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libRockfallFiltersCS.a\")")
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff
  DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/rockfalldda")
install(DIRECTORY docs/ DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/rockfalldda/docs")

# ParaView loads by itself what its list of plugins names: the package's script adds a line.
set(paraview "/usr/${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}")
set(config "${paraview}/rockfall.xml")
cmake_path(GET paraview PARENT_PATH paraview)
configure_file(Plugin/package/postinst.in "${CMAKE_BINARY_DIR}/package/postinst" @ONLY)
configure_file(Plugin/package/prerm.in "${CMAKE_BINARY_DIR}/package/prerm" @ONLY)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME rockfalldda)
set(CPACK_PACKAGE_CONTACT "The RockfallDDA authors <rockfalldda@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
  "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${PARAVIEW_PLUGIN_SUBDIR}/RockfallDDA")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "paraview, python3-paraview")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-jinja2, python3-matplotlib, python3-gdal")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  "${CMAKE_BINARY_DIR}/package/postinst;${CMAKE_BINARY_DIR}/package/prerm")
include(CPack)
