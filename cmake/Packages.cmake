# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Debian packages, one for each component of the installation: `cpack -G DEB`
# in a build that scripts/make_packages.sh configured. docs/packages.md.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cartographer-sdf)
set(CPACK_PACKAGE_CONTACT "The cartographer_sdf authors <maintainers@users.noreply.example>")
set(CPACK_PACKAGE_VENDOR "The cartographer_sdf authors")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# What programs are linked with, by dpkg-shlibdeps.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

# The commit is part of the version, so that a later build replaces an earlier.
string(REGEX REPLACE "[^A-Za-z0-9.+~]" "." debian_commit "${COMMIT}")
string(TIMESTAMP debian_date "%Y%m%d" UTC)
set(CPACK_DEBIAN_PACKAGE_VERSION "${PROJECT_VERSION}~${debian_date}.${debian_commit}")
set(same_version "(= ${CPACK_DEBIAN_PACKAGE_VERSION})")

set(CPACK_COMPONENTS_ALL program dev)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "The program cartographer_sdf: recognises submaps of saved maps by their free space,\ncloses loops, relocalises, merges and audits maps, without a pose prior.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME cartographer-sdf)

set(CPACK_COMPONENT_DEV_DESCRIPTION
    "Static libraries and headers, to find loop closures in maps of Cartographer 2D from\none's own program: find_package(cartographer_sdf) in CMake.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libcartographer-sdf-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
# The targets that CMake exports include the program.
string(JOIN ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "cartographer-sdf ${same_version}"
  libeigen3-dev libgoogle-glog-dev libabsl-dev libceres-dev libprotobuf-dev protobuf-compiler
  zlib1g-dev liblua5.2-dev libcairo2-dev libyaml-cpp-dev
  nlohmann-json3-dev pkg-config)

if(TARGET cartographer_sdf_live)
  list(APPEND CPACK_COMPONENTS_ALL live)
  set(CPACK_COMPONENT_LIVE_DESCRIPTION
      "Beside a running Cartographer: cartographer_sdf_run_log, which drives a recording, and\nthe library that wraps a map builder, which takes an installed Cartographer to use.")
  set(CPACK_DEBIAN_LIVE_PACKAGE_NAME cartographer-sdf-live)
  set(CPACK_DEBIAN_LIVE_PACKAGE_DEPENDS "cartographer-sdf ${same_version}")
  set(CPACK_DEBIAN_LIVE_PACKAGE_SUGGESTS "libcartographer-sdf-dev ${same_version}")
endif()

if(CARTOGRAPHER_SDF_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
      "The Python module: maps, distance fields, features, matches and loop closing, as\nnumpy arrays.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-cartographer-sdf)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  # The module is for the minor version of Python that it was built with.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "cartographer-sdf ${same_version}, python3 (>= ${MODULE_PYTHON_VERSION}), python3 (<< ${MODULE_NEXT_PYTHON_VERSION}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
      "${CMAKE_CURRENT_SOURCE_DIR}/cmake/debian/python/postinst;${CMAKE_CURRENT_SOURCE_DIR}/cmake/debian/python/prerm")
endif()

# Debian's place for the licence of each package.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES LICENSE RENAME copyright COMPONENT ${component} EXCLUDE_FROM_ALL
    DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME}")
endforeach()

include(CPack)
