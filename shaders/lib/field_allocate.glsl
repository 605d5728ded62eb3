// What fieldPrune() calls, after field.glsl. FIELD_LISTED counts the entries handed out; ahead of them are `listStart`,
// those of place 0.
#ifdef FIELD_FAMILIES
/// Place for a list of up to so many entries; 0 where there is none left, and the list above serves.
uint fieldAllocate(uint entries) {
    uint most = fieldLists.length(), at = most;
    if (push.listStart + FIELD_LISTED < most) at = push.listStart + atomicAdd(FIELD_LISTED, entries);
    return at < most && entries <= most - at ? at : 0;
}
#endif
