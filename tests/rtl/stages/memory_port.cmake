rtl_check(memory_port SOURCES ${rtl}/memory_port.sv)
