#pragma once

/// @file
/// What the filter tests share: listening to messages, and looking into outputs.

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/// Collects what VTK says, errors of executives included, instead of printing it.
class Messages : public vtkOutputWindow
{
public:
  static Messages* New() { VTK_STANDARD_NEW_BODY(Messages); }
  void DisplayErrorText(const char* text) override { this->Errors.emplace_back(text); }
  void DisplayWarningText(const char* text) override { this->Warnings.emplace_back(text); }
  void DisplayText(const char* text) override { this->Notes.emplace_back(text); }

  std::vector<std::string> Errors, Warnings, Notes;

protected:
  Messages() = default;
  ~Messages() override = default;
};

/// A fixture during which nothing is printed, and after which nothing may have gone wrong unseen.
class FilterTest : public ::testing::Test
{
protected:
  void SetUp() override { vtkOutputWindow::SetInstance(this->Heard); }
  void TearDown() override
  {
    for (const std::string& error : this->Heard->Errors)
    {
      ADD_FAILURE() << "unexpected error: " << error;
    }
    for (const std::string& warning : this->Heard->Warnings)
    {
      ADD_FAILURE() << "unexpected warning: " << warning;
    }
    vtkOutputWindow::SetInstance(nullptr);
  }

  /// Exactly one error, with all of these words in it; takes it off the list.
  void ExpectOneError(const std::vector<std::string>& words)
  {
    ASSERT_EQ(this->Heard->Errors.size(), 1u);
    for (const std::string& word : words)
    {
      EXPECT_NE(this->Heard->Errors[0].find(word), std::string::npos)
        << "\"" << word << "\" is not in: " << this->Heard->Errors[0];
    }
    this->Heard->Errors.clear();
  }

  /// A file in a folder of this test's own, under the working directory.
  std::string WriteFile(const std::string& name, const std::string& content)
  {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const std::filesystem::path folder = std::filesystem::current_path() / "files" /
      (std::string(test->test_suite_name()) + "." + test->name());
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name) << content;
    return (folder / name).string();
  }

  vtkNew<Messages> Heard;
};

inline double value(vtkFieldData* data, const char* array, vtkIdType tuple = 0, int component = 0)
{
  vtkDataArray* found = data->GetArray(array);
  if (!found)
  {
    ADD_FAILURE() << "there is no array " << array;
    return 0.0;
  }
  return found->GetComponent(tuple, component);
}

/// Says that a polydata is in this coordinate system.
inline void setCrs(vtkPolyData* data, const char* crs)
{
  vtkNew<vtkStringArray> array;
  array->SetName("TerrainCRS");
  array->InsertNextValue(crs);
  data->GetFieldData()->AddArray(array);
}
