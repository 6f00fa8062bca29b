#pragma once

/// @file
/// Spreadsheets (XLSX, ODS) whose cells are all text, written byte by byte: a ZIP archive of XML
/// files that are stored as they are.

#include "gisFiles.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace rockfall::testing
{

using Rows = std::vector<std::vector<std::string>>;
using Sheets = std::vector<std::pair<std::string, Rows>>;
using Entries = std::vector<std::pair<std::string, std::string>>;

inline std::uint32_t checksum(const std::string& bytes)
{
  std::uint32_t crc = 0xffffffff;
  for (const char byte : bytes)
  {
    crc ^= std::uint8_t(byte);
    for (int bit = 0; bit < 8; ++bit)
    {
      crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
  }
  return ~crc;
}

inline std::string zipOf(const Entries& entries)
{
  const auto word = [](std::uint64_t value, int bytes)
  {
    std::string text;
    for (int k = 0; k < bytes; ++k)
    {
      text += char(value & 0xff);
      value >>= 8;
    }
    return text;
  };
  std::string files, directory;
  for (const auto& [name, content] : entries)
  {
    const auto size = std::uint32_t(content.size());
    const std::string common = word(20, 2) + word(0, 8) + word(checksum(content), 4) +
      word(size, 4) + word(size, 4) + word(std::uint32_t(name.size()), 2) + word(0, 2);
    directory += "PK\x01\x02" + word(20, 2) + common + word(0, 10) +
      word(std::uint32_t(files.size()), 4) + name;
    files += "PK\x03\x04" + common + name + content;
  }
  const auto count = std::uint32_t(entries.size());
  return files + directory + "PK\x05\x06" + word(0, 4) + word(count, 2) + word(count, 2) +
    word(std::uint32_t(directory.size()), 4) + word(std::uint32_t(files.size()), 4) + word(0, 2);
}

inline std::string writeXlsx(const std::string& name, const Sheets& sheets)
{
  const std::string head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>";
  const std::string office = "http://schemas.openxmlformats.org/";
  std::string book, links, types;
  Entries entries;
  for (std::size_t k = 0; k < sheets.size(); ++k)
  {
    const std::string number = std::to_string(k + 1);
    book += "<sheet name=\"" + sheets[k].first + "\" sheetId=\"" + number + "\" r:id=\"rId" +
      number + "\"/>";
    links += "<Relationship Id=\"rId" + number + "\" Type=\"" + office +
      "officeDocument/2006/relationships/worksheet\" Target=\"worksheets/sheet" + number +
      ".xml\"/>";
    types += "<Override PartName=\"/xl/worksheets/sheet" + number +
      ".xml\" ContentType=\"application/"
      "vnd.openxmlformats-officedocument.spreadsheetml.worksheet+xml\"/>";
    std::string data;
    for (std::size_t row = 0; row < sheets[k].second.size(); ++row)
    {
      data += "<row r=\"" + std::to_string(row + 1) + "\">";
      for (std::size_t column = 0; column < sheets[k].second[row].size(); ++column)
      {
        data += "<c r=\"" + std::string(1, char('A' + column)) + std::to_string(row + 1) +
          "\" t=\"inlineStr\"><is><t>" + sheets[k].second[row][column] + "</t></is></c>";
      }
      data += "</row>";
    }
    entries.emplace_back("xl/worksheets/sheet" + number + ".xml",
      head + "<worksheet xmlns=\"" + office + "spreadsheetml/2006/main\"><sheetData>" + data +
        "</sheetData></worksheet>");
  }
  entries.insert(entries.begin(),
    { { "[Content_Types].xml",
        head + "<Types xmlns=\"" + office +
          "package/2006/content-types\"><Default Extension=\"rels\" ContentType=\"application/"
          "vnd.openxmlformats-package.relationships+xml\"/><Override PartName=\"/xl/workbook.xml\" "
          "ContentType=\"application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"
          "\"/>" +
          types + "</Types>" },
      { "_rels/.rels",
        head + "<Relationships xmlns=\"" + office +
          "package/2006/relationships\"><Relationship Id=\"rId1\" Type=\"" + office +
          "officeDocument/2006/relationships/officeDocument\" Target=\"xl/workbook.xml\"/>"
          "</Relationships>" },
      { "xl/workbook.xml",
        head + "<workbook xmlns=\"" + office + "spreadsheetml/2006/main\" xmlns:r=\"" + office +
          "officeDocument/2006/relationships\"><sheets>" + book + "</sheets></workbook>" },
      { "xl/_rels/workbook.xml.rels",
        head + "<Relationships xmlns=\"" + office + "package/2006/relationships\">" + links +
          "</Relationships>" } });
  return writeFile(name, zipOf(entries));
}

inline std::string writeOds(const std::string& name, const Sheets& sheets)
{
  std::string tables;
  for (const auto& [title, rows] : sheets)
  {
    tables += "<table:table table:name=\"" + title + "\">";
    for (const auto& row : rows)
    {
      tables += "<table:table-row>";
      for (const std::string& cell : row)
      {
        tables += "<table:table-cell office:value-type=\"string\"><text:p>" + cell +
          "</text:p></table:table-cell>";
      }
      tables += "</table:table-row>";
    }
    tables += "</table:table>";
  }
  const std::string space = "urn:oasis:names:tc:opendocument:xmlns:";
  const std::string kind = "application/vnd.oasis.opendocument.spreadsheet";
  return writeFile(name,
    zipOf({ { "mimetype", kind },
      { "META-INF/manifest.xml",
        "<?xml version=\"1.0\"?><manifest:manifest xmlns:manifest=\"" + space +
          "manifest:1.0\"><manifest:file-entry manifest:media-type=\"" + kind +
          "\" manifest:full-path=\"/\"/></manifest:manifest>" },
      { "content.xml",
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><office:document-content xmlns:office=\"" +
          space + "office:1.0\" xmlns:table=\"" + space + "table:1.0\" xmlns:text=\"" + space +
          "text:1.0\" office:version=\"1.2\"><office:body><office:spreadsheet>" + tables +
          "</office:spreadsheet></office:body></office:document-content>" } }));
}

} // namespace rockfall::testing
