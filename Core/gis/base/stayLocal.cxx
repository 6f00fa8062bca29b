#include "gis/base/stayLocal.h"

#include "gis/base/externalReferences.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>

namespace rockfall::gis
{

namespace
{

using Option = std::pair<const char*, const char*>;

constexpr Option shutOptions[] = {
  // /vsicurl/ and its kin ask no callback. An ending that no address has: all others are refused.
  { "CPL_VSIL_CURL_ALLOWED_EXTENSIONS", ".nothing-is-allowed" },
  { "CPL_VSIL_CURL_ALLOWED_FILENAME", "nothing" },
  // Fetches of many at once ask none either. libcurl knows no such proxy and does not connect.
  { "GDAL_HTTP_PROXY", "nobody://127.0.0.1" },
  { "GDAL_HTTPS_PROXY", "nobody://127.0.0.1" },
  { "CPL_ALLOW_VSISTDIN", "NO" },
  // VirtualText, VirtualShape, VirtualXPath and their kin are modules of SpatiaLite, VirtualOGR is
  // GDAL's own.
  { "SPATIALITE_LOAD", "NO" },
  { "OGR_SQLITE_STATIC_VIRTUAL_OGR", "NO" },
  { "OGR_SQLITE_LIST_VIRTUAL_OGR", "NO" },
  { "OGR_SQLITE_LOAD_EXTENSIONS", nullptr },
  { "ALLOW_VIRTUAL_OGR_FROM_TRIGGER_AND_VIEW", "NO" },
  { "ALLOW_OGR_SQL_FUNCTIONS_FROM_TRIGGER_AND_VIEW", "NO" },
  { "GDAL_VRT_ENABLE_PYTHON", "NO" },
  // All of this holds on one thread: GDAL shall have no others for a mosaic.
  { "VRT_NUM_THREADS", "1" },
};

constexpr Option openOptions[] = {
  // GDAL 3.13 reads raw numbers only beside the VRT that names them.
  { "GDAL_VRT_RAWRASTERBAND_ALLOWED_SOURCE", "ALL" },
};

thread_local std::string refusedAddress;

/// An answer to every request, so that GDAL sends none.
CPLHTTPResult* refuseFetch(
  const char* address, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*, void*)
{
  if (refusedAddress.empty())
  {
    refusedAddress = address;
  }
  CPLError(CE_Failure, CPLE_HttpResponse, "%s is an address, which is not opened", address);
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("addresses are not opened");
  return result;
}

} // namespace

StayLocal::StayLocal()
  : shut_(openingDrivers() != nullptr)
{
  const auto set = [this](const Option& option)
  {
    const char* old = CPLGetThreadLocalConfigOption(option.first, nullptr);
    before_.emplace_back(option.first, old ? std::optional<std::string>(old) : std::nullopt);
    CPLSetThreadLocalConfigOption(option.first, option.second);
  };
  if (!shut_)
  {
    for (const Option& option : openOptions)
    {
      set(option);
    }
    return;
  }
  for (const Option& option : shutOptions)
  {
    set(option);
  }
  CPLHTTPPushFetchCallback(refuseFetch, nullptr);
}

StayLocal::~StayLocal()
{
  if (shut_)
  {
    CPLHTTPPopFetchCallback();
  }
  for (auto option = before_.rbegin(); option != before_.rend(); ++option)
  {
    CPLSetThreadLocalConfigOption(
      option->first, option->second ? option->second->c_str() : nullptr);
  }
}

std::string takeRefusedAddress()
{
  return std::exchange(refusedAddress, {});
}

} // namespace rockfall::gis
