#include "gis/base/hdf5References.h"

#include <cpl_vsi.h>
#include <hdf5.h>

#include <cstring>
#include <memory>

namespace rockfall::gis
{

namespace
{

constexpr char hdf5Signature[] = "\x89HDF\r\n\x1a\n";
constexpr std::size_t hdf5SignatureSize = sizeof hdf5Signature - 1;
/// The signature may stand behind a block of the user's, at 0, 512, 1024, 2048 …
constexpr vsi_l_offset firstBlock = 512, largestBlock = 1 << 26;

/// A number of HDF5 for something that is open.
class Hdf5Handle
{
public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t))
    : id_(id)
    , close_(close)
  {
  }
  ~Hdf5Handle()
  {
    if (id_ >= 0)
    {
      close_(id_);
    }
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;

  operator hid_t() const { return id_; }
  bool good() const { return id_ >= 0; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// While it lives, HDF5 prints no errors on this thread.
class SilentHdf5
{
public:
  SilentHdf5()
  {
    H5Eget_auto2(H5E_DEFAULT, &before_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~SilentHdf5() { H5Eset_auto2(H5E_DEFAULT, before_, data_); }
  SilentHdf5(const SilentHdf5&) = delete;
  SilentHdf5& operator=(const SilentHdf5&) = delete;

private:
  H5E_auto2_t before_ = nullptr;
  void* data_ = nullptr;
};

using FileNames = std::vector<std::string>;

/// Of numbers that are stored elsewhere, and of virtual datasets.
bool takeStorage(hid_t dataset, FileNames& names)
{
  const Hdf5Handle how(H5Dget_create_plist(dataset), H5Pclose);
  if (!how.good())
  {
    return false;
  }
  const int external = H5Pget_external_count(how);
  for (int k = 0; k < external; ++k)
  {
    std::string name(4096, '\0');
    off_t offset = 0;
    hsize_t size = 0;
    if (H5Pget_external(how, unsigned(k), name.size() - 1, name.data(), &offset, &size) < 0)
    {
      return false;
    }
    names.emplace_back(name.c_str());
  }
  if (H5Pget_layout(how) != H5D_VIRTUAL)
  {
    return external >= 0;
  }
  size_t sources = 0;
  if (H5Pget_virtual_count(how, &sources) < 0)
  {
    return false;
  }
  for (size_t k = 0; k < sources; ++k)
  {
    const ssize_t length = H5Pget_virtual_filename(how, k, nullptr, 0);
    if (length < 0)
    {
      return false;
    }
    std::string name(std::size_t(length) + 1, '\0');
    H5Pget_virtual_filename(how, k, name.data(), name.size());
    names.emplace_back(name.c_str());
  }
  return true;
}

/// FileNames the file of an external link.
bool takeLink(hid_t group, const char* link, size_t size, FileNames& names)
{
  std::vector<char> value(size);
  const char* file = nullptr;
  if (H5Lget_val(group, link, value.data(), size, H5P_DEFAULT) < 0 ||
    H5Lunpack_elink_val(value.data(), size, nullptr, &file, nullptr) < 0)
  {
    return false;
  }
  names.emplace_back(file);
  return true;
}

herr_t visitLink(hid_t group, const char* link, const H5L_info_t* info, void* data)
{
  FileNames& names = *static_cast<FileNames*>(data);
  if (info->type == H5L_TYPE_EXTERNAL)
  {
    return takeLink(group, link, info->u.val_size, names) ? 0 : -1;
  }
  if (info->type != H5L_TYPE_HARD)
  {
    return info->type == H5L_TYPE_SOFT ? 0 : -1; // a link of somebody's own making
  }
  const Hdf5Handle object(H5Oopen(group, link, H5P_DEFAULT), H5Oclose);
  return object.good() && (H5Iget_type(object) != H5I_DATASET || takeStorage(object, names)) ? 0
                                                                                             : -1;
}

} // namespace

bool isHdf5(const std::string& path)
{
  VSIStatBufL status;
  if (VSIStatL(path.c_str(), &status) != 0 || !VSI_ISREG(status.st_mode))
  {
    return false;
  }
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(
    VSIFOpenL(path.c_str(), "rb"), VSIFCloseL);
  for (vsi_l_offset at = 0; file && at <= largestBlock; at = at ? 2 * at : firstBlock)
  {
    char bytes[hdf5SignatureSize];
    if (VSIFSeekL(file.get(), at, SEEK_SET) != 0 ||
      VSIFReadL(bytes, 1, hdf5SignatureSize, file.get()) != hdf5SignatureSize)
    {
      return false;
    }
    if (std::memcmp(bytes, hdf5Signature, hdf5SignatureSize) == 0)
    {
      return true;
    }
  }
  return false;
}

std::optional<std::vector<std::string>> hdf5References(const std::string& path)
{
  const SilentHdf5 silence;
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  FileNames names;
  if (!file.good() || H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visitLink, &names) < 0)
  {
    return std::nullopt;
  }
  return names;
}

} // namespace rockfall::gis
