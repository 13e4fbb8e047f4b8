# Writes version.cpp anew whenever the commit, or whether the tree has changed since, is another than at the last build:
# the files of an archive name the commit of the program that wrote them.
# Usage: cmake -DROOT=... -DINPUT=... -DOUTPUT=... -DPROJECT_VERSION=... -DCOMPILER=... -P version.cmake
find_package(Git QUIET)
set(LUMENLINE_COMMIT unknown)
if(Git_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --dirty --exclude=*
                  WORKING_DIRECTORY ${ROOT}
                  OUTPUT_VARIABLE LUMENLINE_DESCRIBED OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(LUMENLINE_DESCRIBED)
    set(LUMENLINE_COMMIT ${LUMENLINE_DESCRIBED})
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
