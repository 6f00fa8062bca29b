# The library of HDF5 that Debian's GDAL uses, without MPI: ROCKFALL_HDF5_LIBRARY, and for the sources that
# include it ROCKFALL_HDF5_INCLUDE. Not by find_package(HDF5), whose result ParaView's own search for the
# one with MPI would find in the cache.
find_path(ROCKFALL_HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial REQUIRED)
find_library(ROCKFALL_HDF5_LIBRARY NAMES hdf5_serial hdf5 REQUIRED)
mark_as_advanced(ROCKFALL_HDF5_INCLUDE ROCKFALL_HDF5_LIBRARY)
