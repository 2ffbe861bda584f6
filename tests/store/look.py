"""What ParaView's readers find in results: one JSON object a line for each folder and reader.

Run by pvpython, or by a Python that has VTK's readers: look.py FOLDER...
"""
import json
import os
import sys


def of_paraview():
    """Version and readers by their names there; each gives times, and the data at a time."""
    from paraview import servermanager, simple

    def reader(make):
        def opened(path):
            source = make(FileNames=[path]) if make is simple.XDMFReader else make(FileName=[path])
            source.UpdatePipelineInformation()

            def at(time):
                source.UpdatePipeline(time)
                return servermanager.Fetch(source)
            return [float(t) for t in source.TimestepValues], at
        return opened
    names = ("XDMFReader", "Xdmf3ReaderS", "Xdmf3ReaderT")
    version = str(servermanager.vtkSMProxyManager.GetParaViewSourceVersion())
    return version, {name: reader(getattr(simple, name)) for name in names}


def of_vtk():
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    from vtkmodules.vtkIOXdmf3 import vtkXdmf3Reader

    def reader(make):
        def opened(path):
            source = make()
            source.SetFileName(path)
            source.UpdateInformation()
            told = source.GetOutputInformation(0)

            def at(time):
                source.UpdateTimeStep(time)
                return source.GetOutputDataObject(0)
            return [float(t) for t in told.Get(pipeline.TIME_STEPS()) or ()], at
        return opened
    return ("VTK " + vtkVersion.GetVTKVersion(),
            {"vtkXdmfReader": reader(vtkXdmfReader), "vtkXdmf3Reader": reader(vtkXdmf3Reader)})


def leaves(data):
    """Name and data of every piece that has points. Readers number the frames: bar, bar[1], ..."""
    if not data.IsA("vtkCompositeDataSet"):
        yield "", data
        return
    walk = data.NewIterator()
    walk.InitTraversal()
    while not walk.IsDoneWithTraversal():
        told = walk.GetCurrentMetaData() if walk.HasCurrentMetaData() else None
        name = told.Get(data.NAME()) if told else None
        yield (name or "").split("[")[0], walk.GetCurrentDataObject()
        walk.GoToNextItem()


def mark_of(array):
    """A sum over all numbers that tells their order as well."""
    columns = array.GetNumberOfComponents()
    return sum(array.GetComponent(i, k) * (1 + (columns * i + k) % 97)
               for i in range(array.GetNumberOfTuples()) for k in range(columns))


def describe(data):
    points, arrays = data.GetPoints(), data.GetPointData()
    found = {}
    for i in range(arrays.GetNumberOfArrays()):
        array = arrays.GetArray(i)
        found[array.GetName()] = [array.GetNumberOfTuples(), array.GetNumberOfComponents(),
                                  mark_of(array)]
    place = points.GetData()
    return {"points": data.GetNumberOfPoints(), "cells": data.GetNumberOfCells(),
            "place": mark_of(place), "precision": place.GetDataTypeSize(), "arrays": found}


def main():
    try:
        version, readers = of_paraview()
    except ImportError:
        version, readers = of_vtk()
    for folder in sys.argv[1:]:
        for name, opened in readers.items():
            times, at = opened(os.path.join(folder, "results.xdmf"))
            frames = [[(body, describe(data)) for body, data in leaves(at(time))]
                      for time in times]
            print(json.dumps({"version": version, "reader": name, "folder": folder,
                              "times": times, "frames": frames}))
            sys.stdout.flush()


main()
