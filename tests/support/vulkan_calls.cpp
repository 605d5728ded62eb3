#include "tests/support/vulkan_calls.h"

#include <dlfcn.h>

namespace fw::test {
namespace {

thread_local bool forTheHost = false, ended = false;
uint64_t budgetOfHeaps = 0;

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
#define NEXT(name) static auto* const real = fw::test::next<decltype(name)>(#name)

}  // namespace

bool endedForTheHost() { return ended; }
void setBudget(uint64_t bytes) { budgetOfHeaps = bytes; }

}  // namespace fw::test

extern "C" {

VKAPI_ATTR void VKAPI_CALL vkCmdPipelineBarrier2(VkCommandBuffer commands, const VkDependencyInfo* info) {
    NEXT(vkCmdPipelineBarrier2);
    for (uint32_t i = 0; i < info->memoryBarrierCount; ++i)
        fw::test::forTheHost = info->pMemoryBarriers[i].dstStageMask & VK_PIPELINE_STAGE_2_HOST_BIT &&
                               info->pMemoryBarriers[i].dstAccessMask & VK_ACCESS_2_HOST_READ_BIT;
    real(commands, info);
}

VKAPI_ATTR void VKAPI_CALL vkCmdDispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) {
    NEXT(vkCmdDispatch);
    fw::test::forTheHost = false;
    real(commands, x, y, z);
}

VKAPI_ATTR void VKAPI_CALL vkCmdFillBuffer(VkCommandBuffer commands, VkBuffer buffer, VkDeviceSize offset,
                                           VkDeviceSize size, uint32_t word) {
    NEXT(vkCmdFillBuffer);
    fw::test::forTheHost = false;
    real(commands, buffer, offset, size, word);
}

VKAPI_ATTR VkResult VKAPI_CALL vkEndCommandBuffer(VkCommandBuffer commands) {
    NEXT(vkEndCommandBuffer);
    fw::test::ended = fw::test::forTheHost;
    fw::test::forTheHost = false;
    return real(commands);
}

VKAPI_ATTR void VKAPI_CALL vkGetPhysicalDeviceMemoryProperties2(
    VkPhysicalDevice physical, VkPhysicalDeviceMemoryProperties2* properties) {
    NEXT(vkGetPhysicalDeviceMemoryProperties2);
    if (fw::test::budgetOfHeaps == 0) return real(physical, properties);
    auto* budget = static_cast<VkPhysicalDeviceMemoryBudgetPropertiesEXT*>(properties->pNext);
    for (uint64_t& bytes : budget->heapBudget) bytes = fw::test::budgetOfHeaps;
}

}  // extern "C"
