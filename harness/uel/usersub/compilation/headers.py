# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that Abaqus supplies to user routines on the include path."""

from __future__ import annotations

from typing import Final

_ARRAYS = """      interface SMA{local}FloatArrayCreate
        integer(kind=8) function SMA{local}FloatArrayCreateSP(ID, SIZE, INITVAL)
          integer(kind=4), intent(in) :: ID, SIZE
          real(kind=4), intent(in) :: INITVAL
        end function
        integer(kind=8) function SMA{local}FloatArrayCreateDP(ID, SIZE, INITVAL)
          integer(kind=4), intent(in) :: ID, SIZE
          real(kind=8), intent(in) :: INITVAL
        end function
      end interface
      interface
        integer(kind=8) function SMA{local}IntArrayCreate(ID, SIZE, INITVAL)
          integer(kind=4), intent(in) :: ID, SIZE
          integer(kind=4), intent(in), optional :: INITVAL
        end function
        integer(kind=8) function SMA{local}IntArrayAccess(ID)
          integer(kind=4), intent(in) :: ID
        end function
        integer(kind=8) function SMA{local}FloatArrayAccess(ID)
          integer(kind=4), intent(in) :: ID
        end function
        integer(kind=4) function SMA{local}IntArraySize(ID)
          integer(kind=4), intent(in) :: ID
        end function
        integer(kind=4) function SMA{local}FloatArraySize(ID)
          integer(kind=4), intent(in) :: ID
        end function
        subroutine SMA{local}IntArrayDelete(ID)
          integer(kind=4), intent(in) :: ID
        end subroutine
        subroutine SMA{local}FloatArrayDelete(ID)
          integer(kind=4), intent(in) :: ID
        end subroutine
      end interface
"""

_UTILITIES = """      interface
        integer(kind=4) function getNumThreads()
        end function
        integer(kind=4) function get_thread_id()
        end function
        subroutine MutexInit(ID)
          integer(kind=4), intent(in) :: ID
        end subroutine
        subroutine MutexLock(ID)
          integer(kind=4), intent(in) :: ID
        end subroutine
        subroutine MutexUnlock(ID)
          integer(kind=4), intent(in) :: ID
        end subroutine
      end interface
"""

_FOR_C = """#ifndef FOR_NAME
/* name of a Fortran routine; the second argument is its name on other systems */
#define FOR_NAME(name, ...) name##_
#endif
"""

_GLOBAL_AND_LOCAL = _ARRAYS.format(local="") + _ARRAYS.format(local="Local")

HEADERS: Final = {
    "aba_param.inc": "      implicit real*8(a-h,o-z)\n      parameter (nprecd=2)\n",
    "smaaspuserarrays.hdr": _GLOBAL_AND_LOCAL,
    "smaaspuserutilities.hdr": _UTILITIES,
    "smaaspusersubroutines.hdr": _GLOBAL_AND_LOCAL + _UTILITIES,
    "aba_for_c.h": _FOR_C,
    "omi_for_c.h": _FOR_C,
}
"""Text by lower-case name; Fortran's is valid in fixed and in free form."""
