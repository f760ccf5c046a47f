# Run as a script: FOLDER/all.cpp includes every source that Verilator wrote there, as their names are not known before.
file(GLOB sources ${FOLDER}/V*.cpp)
set(text "")
foreach(source IN LISTS sources)
  cmake_path(GET source FILENAME name)
  string(APPEND text "#include \"${name}\"\n")
endforeach()
file(WRITE ${FOLDER}/all.cpp "${text}")
