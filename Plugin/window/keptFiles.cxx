#include "keptFiles.h"

#include "undo.h"

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "vtkCommand.h"
#include "vtkSMFileListDomain.h"
#include "vtkSMOrderedPropertyIterator.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMStringVectorProperty.h"

#include <string>

namespace rockfall::window
{

namespace
{

/// Keeps the name that a property has now.
class Keeper : public vtkCommand
{
public:
  static Keeper* New() { return new Keeper; }
  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    keep(vtkSMProperty::SafeDownCast(caller));
  }
  static std::string keyOf(vtkSMProperty* property)
  {
    return std::string("RockfallFile") + property->GetXMLName();
  }
  static void keep(vtkSMProperty* property)
  {
    const NotUndone own;
    const char* name = vtkSMPropertyHelper(property).GetAsString();
    if (name && *name)
    {
      property->GetParent()->SetAnnotation(keyOf(property).c_str(), name);
    }
    else if (property->GetParent()->HasAnnotation(keyOf(property).c_str()))
    {
      property->GetParent()->RemoveAnnotation(keyOf(property).c_str());
    }
  }
};

} // namespace

void keepFiles(pqPipelineSource* source)
{
  vtkSMProxy* proxy = source->getProxy();
  vtkNew<vtkSMOrderedPropertyIterator> properties;
  properties->SetProxy(proxy);
  vtkNew<Keeper> keeper;
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    auto* file = vtkSMStringVectorProperty::SafeDownCast(properties->GetProperty());
    if (!file || !file->FindDomain<vtkSMFileListDomain>())
    {
      continue;
    }
    const std::string key = Keeper::keyOf(file);
    const char* name = vtkSMPropertyHelper(file).GetAsString();
    if (pqApplicationCore::instance()->isLoadingState() && (!name || !*name) &&
      proxy->HasAnnotation(key.c_str()))
    {
      const NotUndone own;
      vtkSMPropertyHelper(file).Set(proxy->GetAnnotation(key.c_str()));
      proxy->UpdateVTKObjects();
    }
    Keeper::keep(file);
    file->AddObserver(vtkCommand::ModifiedEvent, keeper);
  }
}

} // namespace rockfall::window
